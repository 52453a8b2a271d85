//! The driver of Mitsuba, tested with programs that imitate Mitsuba and fail in one way each.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use boresight::files::write_radiance;
use boresight::mitsuba::{MitsubaOptions, MitsubaRenderer};
use contract::Camera;
use contract::docking::Pose;
use nalgebra::Vector3;
use sim::scene::docking::{DockingScene, Lighting, Sun};
use sim::vector::RadianceImage;
use tempfile::TempDir;

const HELP: &str =
    "if [ \"$1\" = --help ]; then echo 'Mitsuba version 3.9.1 (Linux)'; echo ' scalar_rgb'; exit 0; fi\n";

/// A directory with a program instead of Mitsuba, and the images that the program may copy: `good.exr` of 4 ×
/// 3 px and some that are no image of the scene.
struct FakeMitsuba {
    folder: TempDir,
}

impl FakeMitsuba {
    fn new(script: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let image = |radiance: Vec<f32>| RadianceImage { columns: 4, rows: 3, radiance };
        let write =
            |name: &str, image: &RadianceImage| write_radiance(&folder.path().join(name), image).unwrap();
        write("good.exr", &image(vec![0.5; 12]));
        let bad = |value: f32| (0..12).map(|i| if i == 6 { value } else { 0.5 }).collect();
        write("nan.exr", &image(bad(f32::NAN)));
        write("negative.exr", &image(bad(-1.0)));
        write("small.exr", &RadianceImage { columns: 3, rows: 2, radiance: vec![0.5; 6] });
        let stage = Self { folder };
        stage.script(script);
        stage
    }

    /// Writes the script, in which `$STAGE` is the directory; a render adds a line to its file `renders`.
    fn script(&self, body: &str) {
        let path = self.path("mitsuba");
        let text = format!("STAGE='{}'\n{body}\n", self.folder.path().display());
        fs::write(&path, text).unwrap();
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn renderer(&self, time_limit_s: f64) -> MitsubaRenderer {
        // Run by a shell: a file that was just written cannot be executed while another thread is starting a
        // process, which also has it open.
        self.renderer_of(format!("sh '{}'", self.path("mitsuba").display()), time_limit_s)
    }

    fn renderer_of(&self, command: String, time_limit_s: f64) -> MitsubaRenderer {
        let command = Some(command);
        let cache = Some(self.path("cache"));
        MitsubaRenderer::new(MitsubaOptions { command, cache, time_limit_s, ..MitsubaOptions::default() })
            .unwrap()
    }

    fn renders(&self) -> usize {
        fs::read_to_string(self.path("renders")).unwrap_or_default().lines().count()
    }

    fn message(&self) -> String {
        render(&self.renderer(30.0), 5.0).unwrap_err()
    }
}

fn copies(image: &str) -> String {
    format!("{HELP}echo x >> $STAGE/renders; cp $STAGE/{image} image.exr")
}

fn render(renderer: &MitsubaRenderer, distance_m: f64) -> Result<RadianceImage, String> {
    let camera = Camera {
        columns: 4,
        rows: 3,
        focal_length_mm: 1.0,
        pixel_width_um: 10.0,
        pixel_height_um: 10.0,
        principal_x_px: 1.5,
        principal_y_px: 1.0,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    };
    let sun = Some(Sun { towards: Vector3::z(), irradiance: 1.0 });
    let lighting = Lighting { sun, floodlight: None, fill_radiance: 0.1, sky_radiance: 0.0 };
    let pose = Pose { position_m: Vector3::new(0.0, 0.0, distance_m), phi_rad: Vector3::zeros() };
    renderer.radiance(&DockingScene::default(), &lighting, &pose, &camera).map_err(|error| error.to_string())
}

#[test]
fn the_image_is_the_sum_of_sun_and_fill() {
    let stage = FakeMitsuba::new(&copies("good.exr"));
    assert_eq!(render(&stage.renderer(30.0), 5.0).unwrap().radiance, vec![1.0; 12]);
    assert_eq!(stage.renders(), 2);
}

#[test]
fn mitsuba_gets_variant_threads_and_path() {
    let stage = FakeMitsuba::new(&format!("{}; echo \"$@\" > $STAGE/arguments", copies("good.exr")));
    render(&stage.renderer(30.0), 5.0).unwrap();
    let arguments = fs::read_to_string(stage.path("arguments")).unwrap();
    assert_eq!(arguments.trim(), "-m scalar_rgb -t 4 -o image.exr scene.xml");
}

#[test]
fn a_cached_image_is_reused_even_without_mitsuba() {
    let stage = FakeMitsuba::new(&copies("good.exr"));
    let first = render(&stage.renderer(30.0), 5.0).unwrap();
    stage.script("exit 1");
    assert_eq!(render(&stage.renderer(30.0), 5.0).unwrap(), first);
    assert_eq!(stage.renders(), 2);
    assert!(render(&stage.renderer(30.0), 6.0).is_err(), "another pose is another image");
}

#[test]
fn a_damaged_image_of_the_cache_is_made_anew() {
    let stage = FakeMitsuba::new(&copies("good.exr"));
    let first = render(&stage.renderer(30.0), 5.0).unwrap();
    let files: Vec<_> =
        fs::read_dir(stage.path("cache")).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(files.len(), 2, "images only, no folder of a render is left: {files:?}");
    fs::write(&files[0], b"half an image").unwrap();
    assert_eq!(render(&stage.renderer(30.0), 5.0).unwrap(), first);
    assert_eq!(stage.renders(), 3);
}

#[test]
fn many_at_once_with_one_cache_all_get_the_image() {
    let stage = FakeMitsuba::new(&format!("{HELP}sleep 0.05; cp $STAGE/good.exr image.exr"));
    std::thread::scope(|scope| {
        let all: Vec<_> = (0..6).map(|_| scope.spawn(|| render(&stage.renderer(30.0), 5.0))).collect();
        for one in all {
            assert_eq!(one.join().unwrap().unwrap().radiance, vec![1.0; 12]);
        }
    });
}

#[test]
fn a_missing_command_is_named() {
    let stage = FakeMitsuba::new("");
    let renderer = stage.renderer_of(stage.path("nowhere").display().to_string(), 30.0);
    let message = render(&renderer, 5.0).unwrap_err();
    assert!(message.contains("Mitsuba cannot be started with"), "{message}");
}

#[test]
fn another_version_is_refused_and_so_is_another_program() {
    let message = FakeMitsuba::new("echo 'Mitsuba version 3.5.0 (Linux)'; echo scalar_rgb").message();
    assert!(message.contains("is Mitsuba 3.5.0, expected Mitsuba 3.9.1"), "{message}");
    let message = FakeMitsuba::new("echo 'hello'; exit 3").message();
    assert!(message.contains("is not Mitsuba (output: hello)"), "{message}");
}

#[test]
fn a_mitsuba_without_the_variant_is_refused() {
    let message = FakeMitsuba::new("echo 'Mitsuba version 3.9.1 (Linux)'; echo llvm_ad_rgb").message();
    assert!(message.contains("lacks the variant scalar_rgb"), "{message}");
}

#[test]
fn a_refused_scene_is_reported_with_mitsubas_message_without_colours() {
    let script = format!(
        "{HELP}printf '\\033[31mCaught a critical exception:\\033[0m no such plugin\\n' >&2; exit 255"
    );
    let message = FakeMitsuba::new(&script).message();
    assert!(message.contains("refused the scene while rendering the layer sun"), "{message}");
    assert!(message.ends_with("Caught a critical exception: no such plugin"), "{message}");
}

#[test]
fn an_abort_is_reported_with_its_status() {
    let message = FakeMitsuba::new(&format!("{HELP}echo 'LLVM ERROR'; exit 250")).message();
    assert!(message.contains("250") && message.contains("LLVM ERROR"), "{message}");
}

#[test]
fn success_without_a_good_image_is_no_success() {
    for (image, words) in [
        ("nan.exr", "NaN at pixel (2, 1)"),
        ("negative.exr", "-1 at pixel (2, 1)"),
        ("small.exr", "has 3×2 px, expected 4×3"),
    ] {
        let stage = FakeMitsuba::new(&copies(image));
        let message = stage.message();
        assert!(message.contains(words) && message.contains("layer sun"), "{message}");
        assert_eq!(fs::read_dir(stage.path("cache")).unwrap().count(), 0, "{image} is kept");
    }
    let message = FakeMitsuba::new(&format!("{HELP}: > image.exr")).message();
    assert!(message.contains("image.exr: not a readable EXR file"), "{message}");
    let message = FakeMitsuba::new(&format!("{HELP}exit 0")).message();
    assert!(message.contains("image.exr: cannot"), "{message}");
}

#[test]
fn a_render_that_hangs_is_ended_with_its_children() {
    let stage = FakeMitsuba::new(&format!("{HELP}sleep 100 & echo $! > $STAGE/child; echo sampling; wait"));
    let begin = Instant::now();
    let message = render(&stage.renderer(0.5), 5.0).unwrap_err();
    assert!(
        message.contains("exceeded the time limit of 0.5 s") && message.contains("sampling"),
        "{message}"
    );
    assert!(begin.elapsed() < Duration::from_secs(30));
    let child = fs::read_to_string(stage.path("child")).unwrap();
    let process = Path::new("/proc").join(child.trim());
    let ended = || match fs::read_to_string(process.join("stat")) {
        // A zombie that has not been reaped yet has ended too.
        Ok(stat) => stat.contains(") Z "),
        Err(_) => true,
    };
    let deadline = Instant::now() + Duration::from_secs(5);
    while !ended() && Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(10));
    }
    assert!(ended(), "the child {} is still there", child.trim());
}

#[test]
fn a_time_limit_that_is_not_positive_and_finite_is_refused() {
    for time_limit_s in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let cache = Some(tempfile::tempdir().unwrap().path().join("cache"));
        let error = MitsubaRenderer::new(MitsubaOptions { cache, time_limit_s, ..MitsubaOptions::default() });
        assert!(error.unwrap_err().to_string().contains("time limit of Mitsuba"));
    }
}
