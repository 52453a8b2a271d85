//! Materials of OBJ and glTF as reflectances.

use super::super::surface::SurfaceConfig;

/// Range of the width of the specular lobe ([`SurfaceConfig::roughness`]), to which files are clamped.
const ROUGHNESS: [f64; 2] = [0.02, 0.6];
/// Reflectance of a dielectric along the normal, of glTF's metallic-roughness model: refractive index 1.5.
const DIELECTRIC: f64 = 0.04;

/// Material of a file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FileMaterial {
    pub name: String,
    /// Its reflectance, or the property of the file's material that the simulator does not have.
    pub surface: Result<SurfaceConfig, String>,
}

/// Reflectance in V of a linear colour: its luminance, Y = 0.2126 R + 0.7152 G + 0.0722 B (ITU-R BT.709). The
/// response of the eye, to which Y belongs, is close to V.
fn in_v([red, green, blue]: [f64; 3]) -> f64 {
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}

/// Returns the reflectance of a material of an MTL file: the luminance of the diffuse colour Kd and of the
/// specular colour Ks, and the width of the lobe of Phong's exponent Ns, α = (2/(Ns + 2))^½ (Walter et al.
/// 2007, EGSR).
pub(super) fn from_phong(
    diffuse: [f64; 3],
    specular: [f64; 3],
    exponent: f64,
) -> Result<SurfaceConfig, String> {
    if exponent.is_nan() || exponent < 0.0 {
        return Err(format!("Ns is {exponent}, expected 0 or more"));
    }
    checked(SurfaceConfig {
        diffuse: in_v(diffuse),
        specular: in_v(specular),
        roughness: (2.0 / (exponent + 2.0)).sqrt().clamp(ROUGHNESS[0], ROUGHNESS[1]),
    })
}

/// Returns the reflectance of glTF's metallic-roughness model, with the luminance Y of the base colour,
/// metalness m and roughness r: ρ_s = 0.04 (1 − m) + Y m, ρ_d = 0.96 (1 − m) Y, α = r² (glTF 2.0, appendix
/// B.2, along the normal).
pub(super) fn from_metallic_roughness(
    base: [f64; 3],
    metallic: f64,
    roughness: f64,
) -> Result<SurfaceConfig, String> {
    let luminance = in_v(base);
    if !(0.0..=1.0).contains(&metallic) || !(0.0..=1.0).contains(&roughness) {
        return Err(format!("metallicFactor {metallic}, roughnessFactor {roughness}: expected 0 to 1"));
    }
    checked(SurfaceConfig {
        diffuse: (1.0 - DIELECTRIC) * (1.0 - metallic) * luminance,
        specular: DIELECTRIC * (1.0 - metallic) + luminance * metallic,
        roughness: (roughness * roughness).clamp(ROUGHNESS[0], ROUGHNESS[1]),
    })
}

/// Checks that a surface reflects no more light than it receives. Rounding of decimal colours is corrected.
fn checked(surface: SurfaceConfig) -> Result<SurfaceConfig, String> {
    let SurfaceConfig { diffuse, specular, .. } = surface;
    let is_possible = diffuse >= 0.0 && specular >= 0.0 && diffuse + specular <= 1.0 + 1e-6;
    if !is_possible {
        return Err(format!(
            "it reflects {diffuse:.4} diffusely and {specular:.4} specularly, more than 1 or less than 0"
        ));
    }
    Ok(SurfaceConfig { diffuse: diffuse.min(1.0), specular: specular.min(1.0 - diffuse.min(1.0)), ..surface })
}
