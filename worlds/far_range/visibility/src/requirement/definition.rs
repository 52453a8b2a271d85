//! Requirements that were read and checked, with their camera.
use std::path::{Path, PathBuf};

use config::toml_file;
use far_range::{CameraPreset, CameraSource, FarRangeScenario};
use files::Failure;
use run::ScenarioSource;
use scenario::{BUILT_IN, BuiltIn, CAMERAS};
use sim::SimError;
use sim::optics::{PsfConfig, RadiometryConfig};
use sim::scene::TargetConfig;

use crate::camera::{CameraConfig, CameraModel};
use crate::requirement::{CameraTable, DetectionRule, RequirementFile, SkyTime, TargetLight};

/// Requirement files that are embedded in the binary, by name.
pub const BUILT_IN_REQUIREMENTS: &[BuiltIn] = &[BuiltIn {
    name: "uasc-far-range",
    text: include_str!("../../../../../scenarios/requirements/uasc-far-range.toml"),
}];

/// Requirements that were read and checked.
#[derive(Debug, Clone)]
pub struct Requirements {
    /// Name of the requirements: that of the built-in file, or the file name without its extension.
    pub name: String,
    /// Content of the requirement file.
    pub file: RequirementFile,
    /// Camera, with all overrides applied.
    pub camera: CameraConfig,
    /// Scenario that the camera was taken from.
    pub scenario: Option<FarRangeScenario>,
    /// Target body.
    pub target: Option<TargetConfig>,
}

/// Text of the requirements, used to locate mistakes.
struct Source<'a> {
    path: &'a Path,
    text: &'a str,
}

impl Requirements {
    /// Reads `word`: a built-in name, or the path of a TOML file.
    ///
    /// # Errors
    /// A [`Failure`] when there is no such file, or with the location of the first mistake in it.
    pub fn read(word: &str) -> Result<Self, Failure> {
        if let Some(built_in) = BUILT_IN_REQUIREMENTS.iter().find(|built_in| built_in.name == word) {
            let path = PathBuf::from(format!("scenarios/requirements/{word}.toml"));
            return Self::parse(word.to_owned(), Path::new(""), &path, built_in.text);
        }
        let path = Path::new(word);
        let text = toml_file::read_text(path).map_err(|error| {
            let names = BUILT_IN_REQUIREMENTS.iter().map(|built_in| built_in.name);
            let hint = match toml_file::nearest(word, names.clone()) {
                Some(nearest) => format!("did you mean `{nearest}`?"),
                None => format!("built-in requirements: {}", names.collect::<Vec<_>>().join(", ")),
            };
            Failure::Usage(format!(
                "`{word}` is neither a built-in requirement file nor a readable TOML file ({error}); {hint}"
            ))
        })?;
        let name =
            path.file_stem().map_or_else(|| word.to_owned(), |stem| stem.to_string_lossy().into_owned());
        Self::parse(name, path.parent().unwrap_or(Path::new("")), path, &text)
    }

    /// Reads requirements from `text`, which is the content of `path`; paths in it are relative to `folder`.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the first mistake.
    pub fn parse(name: String, folder: &Path, path: &Path, text: &str) -> Result<Self, Failure> {
        let source = Source { path, text };
        let file: RequirementFile = toml_file::parse(path, text)?;
        file.check().map_err(|error| toml_file::out_of_range(path, text, &error))?;
        if let SkyTime::Epoch { utc } = &file.sky.when {
            sim::truth::clock::parse_utc(utc)
                .map_err(|error| source.refuse("sky.when.utc", error.to_string()))?;
        }
        let scenario = file.camera.scenario.as_ref().map(|word| source.scenario(word, folder)).transpose()?;
        let camera = source.camera(&file.camera, scenario.as_ref(), folder)?;
        CameraModel::new(&camera).map_err(|error| source.explain(error))?;
        let full_scale_dn = camera.sensor.full_scale_dn();
        if let DetectionRule::Dn { low_dn, high_dn } = file.detection {
            if high_dn >= full_scale_dn {
                let message = format!("is {high_dn}, expected less than full scale, {full_scale_dn}");
                return Err(source.refuse("detection.high_dn", message));
            }
            if low_dn > high_dn {
                return Err(source
                    .refuse("detection.low_dn", format!("is {low_dn}, expected detection.high_dn or less")));
            }
        }
        let target = match &file.target {
            None => None,
            Some(table) => {
                let mut body = table.body.clone();
                for (_, path) in body.iter_mut().flat_map(TargetConfig::paths) {
                    *path = folder.join(&*path).to_string_lossy().into_owned();
                }
                Some(body.or(scenario.as_ref().map(|s| s.target.clone())).ok_or_else(|| {
                    source.refuse(
                        "target",
                        "has no `body`: set it, or set camera.scenario, which defines it".to_owned(),
                    )
                })?)
            }
        };
        if let Some(body) = &target {
            body.check().map_err(|error| source.explain(error.into()))?;
        }
        if let (Some(TargetLight::Orbit { .. }), None) = (file.target.as_ref().map(|t| &t.light), &scenario) {
            let message =
                "is \"orbit\", which needs camera.scenario: the scenario defines the orbit".to_owned();
            return Err(source.refuse("target.light.kind", message));
        }
        Ok(Self { name, file, camera, scenario, target })
    }
}

impl Source<'_> {
    fn refuse(&self, at: &str, message: String) -> Failure {
        toml_file::refuse(self.path, self.text, at, message).into()
    }

    /// Locates a value that the simulator rejects in the file, or in the table that it replaces.
    fn explain(&self, error: SimError) -> Failure {
        let SimError::OutOfRange(error) = error else { return error.into() };
        let field = &error.path;
        let at = match field.as_str() {
            "camera.focal_length_mm" => field.clone(),
            "radiometry.aperture_diameter_mm" => "camera.aperture_diameter_mm".to_owned(),
            _ => match field.strip_prefix("target.") {
                Some(rest) => format!("target.body.{rest}"),
                None => format!("camera.{field}"),
            },
        };
        self.refuse(&at, error.to_string())
    }

    fn scenario(&self, word: &str, folder: &Path) -> Result<FarRangeScenario, Failure> {
        let is_built_in = BUILT_IN.iter().any(|built_in| built_in.name == word);
        let word =
            if is_built_in { word.to_owned() } else { folder.join(word).to_string_lossy().into_owned() };
        let source = match ScenarioSource::read(&word) {
            Err(Failure::Usage(message)) => return Err(self.refuse("camera.scenario", message)),
            other => other?,
        };
        match source.typed::<FarRangeScenario>("camera.scenario") {
            Err(Failure::Usage(message)) => Err(self.refuse("camera.scenario", message)),
            other => other.cloned(),
        }
    }

    fn camera(
        &self,
        table: &CameraTable,
        scenario: Option<&FarRangeScenario>,
        folder: &Path,
    ) -> Result<CameraConfig, Failure> {
        let preset = table.preset.as_ref().map(|name| self.preset(name)).transpose()?;
        let mut config = match (scenario, &preset) {
            (Some(scenario), _) => CameraConfig::from_scenario(scenario),
            (None, Some(preset)) => CameraConfig::from_preset(preset),
            (None, None) => {
                return Err(self.refuse("camera", "is empty, expected a `scenario` or a `preset`".to_owned()));
            }
        };
        // A preset beside a scenario replaces geometry and detector only.
        if let Some(preset) = preset {
            (config.camera, config.sensor) = (preset.camera, preset.sensor);
        }
        replace(&mut config.sensor, &table.sensor);
        replace(&mut config.psf, &table.psf);
        replace(&mut config.optics, &table.optics);
        replace(&mut config.radiometry, &table.radiometry);
        replace(&mut config.background, &table.background);
        if let (PsfConfig::Sampled { path, .. }, true) = (&mut config.psf, table.psf.is_some()) {
            *path = folder.join(&*path).to_string_lossy().into_owned();
        }
        if let Some(focal_length_mm) = table.focal_length_mm {
            config.camera.focal_length_mm = focal_length_mm;
        }
        if let Some(diameter_mm) = table.aperture_diameter_mm {
            match &mut config.radiometry {
                RadiometryConfig::Spectral { aperture_diameter_mm, .. } => {
                    *aperture_diameter_mm = diameter_mm
                }
                RadiometryConfig::ZeroPoint { .. } => {
                    let message = "applies only to spectral radiometry".to_owned();
                    return Err(self.refuse("camera.aperture_diameter_mm", message));
                }
            }
        }
        Ok(config)
    }

    fn preset(&self, name: &str) -> Result<CameraPreset, Failure> {
        let Some(built_in) = CameraSource::built_in(name)? else {
            let names: Vec<_> = CAMERAS.iter().map(|camera| camera.name).collect();
            let message = format!(
                "`{name}` is not a built-in camera; for a camera of your own give `scenario`, a scenario with its \
                 tables; built-in cameras: {}",
                names.join(", ")
            );
            return Err(self.refuse("camera.preset", message));
        };
        Ok(built_in.preset)
    }
}

/// Replaces a value by that of the requirement file, if the file has one.
fn replace<T: Clone>(value: &mut T, given: &Option<T>) {
    if let Some(given) = given {
        value.clone_from(given);
    }
}
