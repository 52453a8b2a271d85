use super::*;

const CONTACT_M: f64 = 0.9;

fn segments() -> SegmentedConfig {
    let swing = OscillationConfig {
        lateral_amplitude_m: [0.2, 0.1],
        lateral_period_s: [9.0, 7.0],
        angular_amplitude_deg: [1.0, 0.7, 0.4],
        angular_period_s: [8.0, 6.0, 5.0],
        angular_phase_deg: [0.0, 90.0, 30.0],
        ..OscillationConfig::default()
    };
    SegmentedConfig {
        start_d3_m: 60.0,
        lateral_at_start_m: [3.0, -2.0],
        lateral_at_contact_m: [0.02, -0.01],
        phi_deg: [0.3, -0.2, 0.5],
        ramp_s: 2.0,
        limit_cycle: OscillationConfig { lateral_amplitude_m: [0.01, 0.02], ..swing },
        segments: vec![
            SegmentConfig::Glide { to_d3_m: Some(30.0), speed_m_s: 2.0, end_speed_m_s: Some(0.5) },
            SegmentConfig::Hold { duration_s: 6.0 },
            SegmentConfig::Retreat { to_d3_m: 35.0, speed_m_s: 1.0, end_speed_m_s: None },
            SegmentConfig::Oscillation { duration_s: 20.0, swing },
            SegmentConfig::Glide { to_d3_m: None, speed_m_s: 1.5, end_speed_m_s: Some(0.1) },
        ],
    }
}

fn approach(config: SegmentedConfig) -> Approach {
    Approach::new(&ApproachConfig::Segments(config), CONTACT_M).unwrap()
}

#[test]
fn rates_are_the_derivatives_of_the_pose() {
    let approach = approach(segments());
    let h = 1e-4;
    for i in 1..2000 {
        let t = approach.duration_s() * f64::from(i) / 2000.0;
        let (before, now, after) = (approach.state_at(t - h), approach.state_at(t), approach.state_at(t + h));
        let velocity = (after.pose.position_m - before.pose.position_m) / (2.0 * h);
        let rate = (after.pose.phi_rad - before.pose.phi_rad) / (2.0 * h);
        // Rounding 60 m × 1e-16 / 1e-4 s, curvature 1 m/s³ × h²; at most 2 m/s² × h across a change of
        // acceleration.
        assert!((velocity - now.velocity_m_s).norm() < 2.5e-4, "at {t} s: {velocity} {}", now.velocity_m_s);
        assert!((rate - now.phi_rate_rad_s).norm() < 1e-6, "at {t} s");
        let range_rate = (after.range_m() - before.range_m()) / (2.0 * h);
        assert!((range_rate - now.range_rate_m_s()).abs() < 2.5e-4, "at {t} s");
    }
}

#[test]
fn neither_position_nor_velocity_jumps() {
    let approach = approach(segments());
    let step_s = 1e-3;
    let steps = (approach.duration_s() / step_s) as u32;
    let mut before = approach.state_at(0.0);
    for i in 1..=steps {
        let now = approach.state_at(f64::from(i) * step_s);
        let jump_m = (now.pose.position_m - before.pose.position_m).norm();
        // This approach has at most 2.3 m/s and 1.6 m/s².
        assert!(jump_m < 2.5e-3, "at step {i}: {jump_m} m");
        assert!((now.velocity_m_s - before.velocity_m_s).norm() < 2e-3, "at step {i}");
        assert!((now.phi_rate_rad_s - before.phi_rate_rad_s).norm() < 1e-4, "at step {i}");
        before = now;
    }
}

#[test]
fn segments_end_at_their_stated_end() {
    let mut config = segments();
    config.limit_cycle = OscillationConfig::default();
    let approach = approach(config);
    // Glide: 30 m at a mean speed of 1.25 m/s.
    let end = approach.state_at(24.0);
    assert!((end.pose.position_m.z - 30.0).abs() < 1e-12 && (end.velocity_m_s.z + 0.5).abs() < 1e-12);
    // Braking from 0.5 m/s over 2 s takes another 0.5 m.
    let held = approach.state_at(28.0);
    assert!((held.pose.position_m.z - 29.5).abs() < 1e-12 && held.velocity_m_s.z == 0.0);
    let contact = approach.state_at(approach.duration_s());
    assert!((contact.pose.position_m - Vector3::new(0.02, -0.01, CONTACT_M)).norm() < 1e-12);
    assert!((contact.velocity_m_s.z + 0.1).abs() < 1e-12);
}

#[test]
fn a_constant_velocity_is_constant_to_the_last_bit() {
    let config = ConstantVelocityConfig {
        position_m: [0.5, -0.25, 20.0],
        velocity_m_s: [-0.125, 0.0625, -0.5],
        phi_deg: [1.0, 0.0, -2.0],
        phi_rate_deg_s: [0.1, -0.1, 0.05],
        duration_s: 32.0,
    };
    let approach = Approach::new(&ApproachConfig::ConstantVelocity(config), CONTACT_M).unwrap();
    for k in 0..64 {
        let t = 0.5 * f64::from(k);
        let state = approach.state_at(t);
        // Powers of two avoid rounding.
        assert_eq!(state.pose.position_m, Vector3::new(0.5 - t / 8.0, -0.25 + t / 16.0, 20.0 - t / 2.0));
        assert_eq!(state.velocity_m_s, Vector3::new(-0.125, 0.0625, -0.5));
        assert_eq!(state.phi_rate_rad_s, Vector3::new(0.1_f64, -0.1, 0.05).map(f64::to_radians));
    }
    // Equivalent motion as a single glide.
    let glide = SegmentedConfig {
        start_d3_m: 20.0,
        lateral_at_start_m: [0.0; 2],
        lateral_at_contact_m: [0.0; 2],
        phi_deg: [0.0; 3],
        ramp_s: 3.0,
        limit_cycle: OscillationConfig::default(),
        segments: vec![SegmentConfig::Glide { to_d3_m: Some(4.0), speed_m_s: 0.5, end_speed_m_s: None }],
    };
    let glide = Approach::new(&ApproachConfig::Segments(glide), CONTACT_M).unwrap();
    assert_eq!(glide.duration_s(), 32.0);
    assert_eq!(glide.state_at(7.0).pose.position_m, Vector3::new(0.0, 0.0, 16.5));
}

#[test]
fn the_camera_of_an_ideal_docking_looks_at_the_target_upright() {
    let pose = Pose { position_m: Vector3::new(0.0, 0.0, 5.0), phi_rad: Vector3::zeros() };
    assert_eq!(target_from_camera(&pose), Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0)));
    // Equals the matrix of the paper to first order.
    let phi = Vector3::new(1e-4, -2e-4, 3e-4);
    let a = target_from_camera(&Pose { phi_rad: phi, ..pose });
    let paper = Matrix3::new(1.0, -phi.z, phi.y, -phi.z, -1.0, phi.x, phi.y, -phi.x, -1.0);
    // Second order: 3e-4² / 2 and products.
    assert!((a - paper).norm() < 2e-7, "{a}");
}

#[test]
fn passive_angles_are_those_of_the_line_to_the_camera() {
    let config = ConstantVelocityConfig {
        position_m: [3.0, -4.0, 12.0],
        velocity_m_s: [0.0, 0.0, -13.0],
        phi_deg: [0.0; 3],
        phi_rate_deg_s: [0.0; 3],
        duration_s: 0.0,
    };
    let state = Approach::new(&ApproachConfig::ConstantVelocity(config), CONTACT_M).unwrap().state_at(0.0);
    assert_eq!(state.range_m(), 13.0);
    assert_eq!(state.range_rate_m_s(), -12.0);
    assert!((state.passive_yaw_rad() - libm::atan2(3.0, 12.0)).abs() < 1e-15);
    assert!((state.passive_pitch_rad() - libm::asin(-4.0 / 13.0)).abs() < 1e-15);
}

#[test]
fn bad_values_are_refused_with_their_path() {
    let refused = |change: &dyn Fn(&mut SegmentedConfig), path: &str| {
        let mut config = segments();
        change(&mut config);
        let message = Approach::new(&ApproachConfig::Segments(config), CONTACT_M).unwrap_err().to_string();
        assert!(message.starts_with(path), "{message}");
    };
    refused(&|c| c.start_d3_m = f64::NAN, "approach.start_d3_m");
    refused(&|c| c.start_d3_m = 0.5, "approach.start_d3_m");
    refused(&|c| c.ramp_s = 0.0, "approach.ramp_s");
    refused(&|c| c.segments.clear(), "approach.segments");
    refused(&|c| c.limit_cycle.angular_period_s[1] = 0.0, "approach.limit_cycle.angular_period_s");
    refused(&|c| c.segments[1] = SegmentConfig::Hold { duration_s: -1.0 }, "approach.segments[1].duration_s");
    refused(&|c| c.segments[1] = SegmentConfig::Hold { duration_s: 1.0 }, "approach.segments[1].duration_s");
    let away = SegmentConfig::Glide { to_d3_m: Some(40.0), speed_m_s: 1.0, end_speed_m_s: None };
    refused(&|c| c.segments[4] = away.clone(), "approach.segments[4].to_d3_m");
    let still = SegmentConfig::Glide { to_d3_m: None, speed_m_s: 0.0, end_speed_m_s: None };
    refused(&|c| c.segments[4] = still.clone(), "approach.segments[4].to_d3_m");
    // From 1 m at 10 m/s the motion would turn after 1.5 s, 6.5 m behind the target.
    let rush = [
        SegmentConfig::Glide { to_d3_m: Some(1.0), speed_m_s: 10.0, end_speed_m_s: None },
        SegmentConfig::Retreat { to_d3_m: 40.0, speed_m_s: 10.0, end_speed_m_s: None },
    ];
    refused(
        &|c| (c.ramp_s, c.segments) = (3.0, rush.to_vec()),
        "approach.segments[1] (d3 where the motion turns",
    );
}
