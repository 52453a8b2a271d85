//! look
mod vector_scene;
use std::io::Write;
use vector_scene::*;
#[test]
fn look() {
    let scene = target();
    let mut drawer = boresight_sim::vector::Drawer::new(&camera(1055.0)).unwrap();
    let mut image = Default::default();
    for (i, (d3, sun)) in
        [(20.0, [0.5, 0.6, 0.8]), (5.0, [-0.9, 0.3, 0.5]), (3.0, [-0.3, 0.9, 0.5]), (1.0, [0.2, 0.5, 0.9])]
            .into_iter()
            .enumerate()
    {
        let mut l = sunlit(sun);
        l.fill_radiance = 0.1;
        if i == 3 {
            l.sun = None;
            l.fill_radiance = 0.02;
            l.floodlight = Some(boresight_sim::scene::docking::Floodlight {
                position_m: Point::new(0.3, 0.2, d3),
                axis: -Point::z(),
                intensity: 3.0,
                inner_half_angle_rad: 0.15,
                outer_half_angle_rad: 0.3,
            });
        }
        let p = pose([0.05 * d3 / 5.0, -0.04 * d3, d3], [0.03, -0.01, 0.05]);
        drawer.draw(&scene, &l, &p, &mut image);
        let t = std::time::Instant::now();
        for _ in 0..50 {
            drawer.draw(&scene, &l, &p, &mut image);
        }
        println!("{d3} m: {:.3} ms", t.elapsed().as_secs_f64() / 50.0 * 1e3);
        let mut f = std::fs::File::create(format!("/tmp/dkdraw_{i}.pgm")).unwrap();
        write!(f, "P5\n{} {}\n255\n", image.columns, image.rows).unwrap();
        f.write_all(
            &image
                .radiance
                .iter()
                .map(|r| (r.max(0.0).powf(1.0 / 2.2) * 255.0).min(255.0) as u8)
                .collect::<Vec<_>>(),
        )
        .unwrap();
    }
}
