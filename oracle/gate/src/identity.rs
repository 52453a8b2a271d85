//! Identity of a run, and the check whether two runs can be compared.
use files::Failure;
use run::world_by_name;
use scenario::identity::first_difference;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

/// Kind of source that a result is read from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SourceKind {
    /// A run directory: units are frames or fields.
    Run,
    /// A study: units are cases.
    Study,
}

impl SourceKind {
    /// Returns the plural name of the units in the given world.
    pub fn units(self, world: &str) -> String {
        match self {
            Self::Study => "cases".to_owned(),
            Self::Run => format!("{}s", world_by_name(world).map_or("frame", |world| world.image())),
        }
    }
}

/// Everything that the figures depend on, except the code of the pipeline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Identity {
    /// Run or study.
    pub kind: SourceKind,
    /// Code of a world, as in `far_range`.
    pub world: String,
    /// Name of the scenario or study.
    pub name: String,
    /// Seed of the run or study.
    pub seed: u64,
    /// Version of Boresight that made the run or study.
    pub version: String,
    /// SHA-256 of the star catalogue's source; absent for scenarios without stars.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub catalog_sha256: Option<String>,
    /// Stage whose result was replaced by the truth; absent if no stage was replaced.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inject: Option<String>,
    /// Renderer of the scene; absent for the fast renderer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub renderer: Option<String>,
    /// Number of first frames that no figure counts; absent when 0.
    #[serde(default, skip_serializing_if = "score::is_zero")]
    pub warm_up_frames: u64,
    /// SHA-256 of the resolved scenario without its title, its seed and the pipeline's parameters. The path
    /// of every file that the scenario reads is replaced by the file's content.
    pub scenario_sha256: String,
    /// For a run, SHA-256 of all data of the frames except their pixels: the telemetry as a pipeline receives
    /// it, including the transmitted regions, and all files of the truth. For a study, SHA-256 of all seeds
    /// and drawn values.
    pub frames_sha256: String,
    /// Parameters of the pipeline.
    pub pipeline: Table,
    /// The resolved scenario without the pipeline's parameters.
    pub scenario: Table,
}

/// Pairing of a result with a baseline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Pairing {
    /// The frames are identical: each frame is its own control.
    Frames,
    /// The scenario is the same, but the noise differs: each block of the result is compared with the same
    /// time span of the baseline.
    Blocks,
}

impl Identity {
    /// Returns the pairing by which `result` is compared with this baseline.
    ///
    /// # Errors
    /// [`Failure::Usage`] that names the first field in which they differ, with both values.
    pub fn pairing(&self, result: &Self) -> Result<Pairing, Failure> {
        let cannot = |field: &str, baseline: &dyn std::fmt::Display, result: &dyn std::fmt::Display| {
            Failure::Usage(format!(
                "cannot compare: `{field}` is `{baseline}` in the baseline and `{result}` in the result; \
                 both need the same value"
            ))
        };
        let optional = |text: &Option<String>| text.clone().unwrap_or_else(|| "none".to_owned());
        if self.kind != result.kind {
            let word = |kind| if kind == SourceKind::Run { "run" } else { "study" };
            return Err(cannot("kind", &word(self.kind), &word(result.kind)));
        }
        if self.world != result.world {
            return Err(cannot("world", &self.world, &result.world));
        }
        for (field, of_baseline, of_result) in [
            ("inject", &self.inject, &result.inject),
            ("renderer", &self.renderer, &result.renderer),
            ("catalog_sha256", &self.catalog_sha256, &result.catalog_sha256),
        ] {
            if of_baseline != of_result {
                return Err(cannot(field, &optional(of_baseline), &optional(of_result)));
            }
        }
        if self.warm_up_frames != result.warm_up_frames {
            return Err(cannot("score.warm_up_frames", &self.warm_up_frames, &result.warm_up_frames));
        }
        if self.scenario_sha256 != result.scenario_sha256 {
            let (at, of_baseline, of_result) = first_difference(
                &Value::Table(self.scenario.clone()),
                &Value::Table(result.scenario.clone()),
            )
            .unwrap_or_else(|| {
                let (a, b) = (self.scenario_sha256.clone(), result.scenario_sha256.clone());
                ("scenario_sha256".to_owned(), a, b)
            });
            if self.name != result.name {
                return Err(Failure::Usage(format!(
                    "cannot compare: the baseline is of `{}` and the result of `{}`, expected the same scenario; \
                     they differ first in `scenario{at}`, which is `{of_baseline}` and `{of_result}`",
                    self.name, result.name
                )));
            }
            return Err(cannot(&format!("scenario{at}"), &of_baseline, &of_result));
        }
        let same = self.seed == result.seed && self.frames_sha256 == result.frames_sha256;
        Ok(if same { Pairing::Frames } else { Pairing::Blocks })
    }
}

#[cfg(test)]
mod tests {
    use scenario::identity::split;
    use scenario::run_file::FileDigests;

    use super::*;

    fn identity(scenario: &str) -> Identity {
        let seed = scenario.parse::<Table>().unwrap()["seed"].as_integer().unwrap() as u64;
        let split = split("far_range", scenario.parse().unwrap(), &FileDigests::new()).unwrap();
        Identity {
            kind: SourceKind::Run,
            world: "far_range".to_owned(),
            name: "test".to_owned(),
            seed,
            version: "0.1.0".to_owned(),
            catalog_sha256: None,
            inject: None,
            renderer: None,
            warm_up_frames: 0,
            scenario_sha256: split.scenario_sha256,
            frames_sha256: "f".to_owned(),
            pipeline: split.pipeline,
            scenario: split.scenario,
        }
    }

    const SCENARIO: &str = "title = \"a\"\nseed = 1\n[psf]\nsigma_px = 0.8\n[far_range]\nthreshold = 4\n[[schedule]]\ncount = 3\n";

    #[test]
    fn title_and_pipeline_may_differ_and_the_frames_are_still_the_same() {
        let other = SCENARIO.replace("\"a\"", "\"b\"").replace("threshold = 4", "threshold = 5");
        assert_eq!(identity(SCENARIO).pairing(&identity(&other)).unwrap(), Pairing::Frames);
    }

    #[test]
    fn another_seed_or_other_frames_leave_the_blocks() {
        let other = identity(&SCENARIO.replace("seed = 1", "seed = 2"));
        assert_eq!(identity(SCENARIO).pairing(&other).unwrap(), Pairing::Blocks);
        let other = Identity { frames_sha256: "g".to_owned(), ..identity(SCENARIO) };
        assert_eq!(identity(SCENARIO).pairing(&other).unwrap(), Pairing::Blocks);
    }

    #[test]
    fn differences_are_named_with_both_values() {
        for (change, parts) in [
            (("sigma_px = 0.8", "sigma_px = 0.9"), ["scenario.psf.sigma_px", "0.8", "0.9"]),
            (("sigma_px = 0.8", "kind = 1"), ["scenario.psf.kind", "none", "1"]),
            (("count = 3", "count = 4"), ["scenario.schedule[0].count", "3", "4"]),
        ] {
            let other = identity(&SCENARIO.replace(change.0, change.1));
            let message = identity(SCENARIO).pairing(&other).unwrap_err().to_string();
            assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        }
        let other = identity(&SCENARIO.replace("sigma_px = 0.8", "sigma_px = 0.9"));
        let other = Identity { name: "another".to_owned(), ..other };
        let message = identity(SCENARIO).pairing(&other).unwrap_err().to_string();
        assert!(message.contains("the baseline is of `test` and the result of `another`"), "{message}");
        let study = Identity { kind: SourceKind::Study, ..identity(SCENARIO) };
        let message = identity(SCENARIO).pairing(&study).unwrap_err().to_string();
        assert!(message.contains("`run` in the baseline and `study` in the result"), "{message}");
    }

    #[test]
    fn runs_may_differ_only_in_pipeline_and_noise() {
        let text = |text: &str| Some(text.to_owned());
        let base = identity(SCENARIO);
        for (other, parts) in [
            (
                Identity { world: "docking".to_owned(), ..base.clone() },
                ["`world`", "`far_range` in the baseline", "`docking` in the result"],
            ),
            (
                Identity { inject: text("detection"), ..base.clone() },
                ["`inject`", "`none` in the baseline", "`detection` in the result"],
            ),
            (
                Identity { renderer: text("mitsuba"), ..base.clone() },
                ["`renderer`", "`none` in the baseline", "`mitsuba` in the result"],
            ),
            (
                Identity { catalog_sha256: text("ab"), ..base.clone() },
                ["`catalog_sha256`", "`none` in the baseline", "`ab` in the result"],
            ),
            (
                Identity { warm_up_frames: 30, ..base.clone() },
                ["`score.warm_up_frames`", "`0` in the baseline", "`30` in the result"],
            ),
            // A digest that differs although the scenarios are equal.
            (
                Identity { scenario_sha256: "cd".to_owned(), ..base.clone() },
                [
                    "scenario_sha256",
                    &format!("`{}` in the baseline", base.scenario_sha256),
                    "`cd` in the result",
                ],
            ),
        ] {
            let message = base.pairing(&other).unwrap_err().to_string();
            assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        }
        let study = Identity { kind: SourceKind::Study, ..base.clone() };
        let message = study.pairing(&base).unwrap_err().to_string();
        assert!(message.contains("`study` in the baseline and `run` in the result"), "{message}");
        let named = Identity { name: "another".to_owned(), version: "0.2.0".to_owned(), ..base.clone() };
        assert_eq!(base.pairing(&named).unwrap(), Pairing::Frames);
        // Identical frames with different seeds are not paired: the random draws of the pipeline differ.
        assert_eq!(base.pairing(&Identity { seed: 2, ..base.clone() }).unwrap(), Pairing::Blocks);
    }

    #[test]
    fn units_are_called_frames_fields_or_cases() {
        crate::hand_made::register_worlds();
        assert_eq!(SourceKind::Run.units("far_range"), "frames");
        assert_eq!(SourceKind::Run.units("docking"), "fields");
        assert_eq!(["far_range", "docking"].map(|world| SourceKind::Study.units(world)), ["cases"; 2]);
    }
}
