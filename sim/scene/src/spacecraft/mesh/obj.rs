//! Meshes in Wavefront OBJ, with materials in MTL, read by `tobj`.
//!
//! `tobj` receives the statements that describe the shape; the others have no effect on it (normals, texture
//! coordinates, groups, smoothing) or are refused (curves, surfaces, lines, points).

use std::cell::Cell;
use std::io::{BufRead, Read};

use nalgebra::Vector3;
use tobj::{LoadError, LoadOptions};

use super::material::{FileMaterial, from_phong};
use super::{FileMesh, MeshFault};

/// Statements of shapes that are not polygons.
const NO_POLYGONS: [&str; 10] = ["p", "l", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "call"];
/// Statements of colours in MTL.
const COLOURS: [&str; 4] = ["Ka", "Kd", "Ks", "Ke"];
/// Statement that starts the list of all materials, given to `tobj` before the first line of the file.
const LIBRARY: &str = "mtllib materials\n";

/// Reads a mesh. `library` are the materials of its MTL file; `None` without one.
///
/// # Errors
/// A [`MeshFault`] for the first fault of the text.
pub(super) fn read(bytes: &[u8], library: Option<Vec<FileMaterial>>) -> Result<FileMesh, MeshFault> {
    let text = text_of(bytes)?;
    let statements = statements(text)?;
    let materials = materials_of(text, library)?;
    let named = materials.iter().zip(0..).map(|(material, index)| (material.name.clone(), index)).collect();
    let listed =
        materials.iter().map(|material| tobj::Material { name: material.name.clone(), ..Default::default() });
    let listed: Vec<tobj::Material> = listed.collect();
    let line = Cell::new(0);
    let mut reader = Statements { statements: &statements, rest: LIBRARY.as_bytes(), next: 0, line: &line };
    let options = LoadOptions::default();
    let (models, _) = tobj::load_obj_buf(&mut reader, &options, |_| {
        Ok((listed.clone(), std::collections::HashMap::clone(&named)))
    })
    .map_err(|error| explain(error, line.get()))?;
    let mut mesh = FileMesh { materials, ..FileMesh::default() };
    for model in &models {
        add_polygons(&mut mesh, &model.mesh)?;
    }
    Ok(mesh)
}

/// Reads the materials of an MTL file.
///
/// # Errors
/// A [`MeshFault`] for text that is no MTL file.
pub(super) fn read_materials(bytes: &[u8]) -> Result<Vec<FileMaterial>, MeshFault> {
    let expected = "a material library (MTL)";
    let text = text_of(bytes)?;
    // Where a colour has fewer than three words, tobj panics.
    for (line, content) in (1..).zip(text.lines()) {
        let mut words = content.split_whitespace();
        if words.next().is_some_and(|word| COLOURS.contains(&word)) && words.count() < 3 {
            return Err(MeshFault::new(format!("line {line} of which is no colour"), "three numbers"));
        }
    }
    let (materials, _) = tobj::load_mtl_buf(&mut text.as_bytes())
        .map_err(|error| MeshFault::new(format!("which cannot be read ({error})"), expected))?;
    MeshFault::check_materials(materials.len())?;
    if materials.is_empty() {
        return Err(MeshFault::new("without a material", expected));
    }
    Ok(materials
        .iter()
        .map(|material| FileMaterial { name: material.name.clone(), surface: surface(material) })
        .collect())
}

/// Returns the reflectance of a material, or its unsupported property.
fn surface(material: &tobj::Material) -> Result<super::SurfaceConfig, String> {
    let textures = [
        &material.diffuse_texture,
        &material.specular_texture,
        &material.normal_texture,
        &material.shininess_texture,
        &material.dissolve_texture,
        &material.ambient_texture,
    ];
    if let Some(texture) = textures.into_iter().flatten().next() {
        return Err(format!("it has the texture {texture:?}"));
    }
    // Other maps (bump, displacement, reflection) and the keys of other models are not read by tobj.
    let mut others: Vec<&String> = material.unknown_param.keys().collect();
    others.sort();
    let is_map = |key: &&&String| {
        let key = key.to_ascii_lowercase();
        key.starts_with("map_") || ["bump", "disp", "decal", "refl", "norm"].contains(&key.as_str())
    };
    if let Some(map) = others.iter().find(is_map) {
        return Err(format!("it has a texture ({map})"));
    }
    if material.emissive.is_some_and(|colour| colour != [0.0; 3]) {
        return Err("it emits light (Ke)".to_owned());
    }
    if material.dissolve.is_some_and(|opacity| opacity != 1.0) {
        return Err("it is transparent (d)".to_owned());
    }
    if material.unknown_param.get("Tr").is_some_and(|transparency| transparency.parse() != Ok(0.0)) {
        return Err("it is transparent (Tr)".to_owned());
    }
    let diffuse = material.diffuse.ok_or("it has no diffuse colour (Kd)")?;
    from_phong(diffuse, material.specular.unwrap_or([0.0; 3]), material.shininess.unwrap_or(0.0))
}

/// Returns the materials that the text names, in the order of their names in it, each with its reflectance
/// from the library.
fn materials_of(text: &str, library: Option<Vec<FileMaterial>>) -> Result<Vec<FileMaterial>, MeshFault> {
    let of_file = text.lines().find_map(|line| value_of(line, "mtllib"));
    let mut materials = Vec::<FileMaterial>::new();
    for name in text.lines().filter_map(|line| value_of(line, "usemtl")) {
        if materials.iter().any(|known| known.name == name) {
            continue;
        }
        let entry = library.iter().flatten().find(|entry| entry.name == name);
        let problem = || match (&library, of_file) {
            (Some(_), _) => "it is not in the library of target.material_path".to_owned(),
            (None, Some(file)) => {
                format!("it is in the material library {file:?}, which target.material_path does not give")
            }
            (None, None) => "the file names no material library".to_owned(),
        };
        let surface = entry.map_or_else(|| Err(problem()), |entry| entry.surface.clone());
        materials.push(FileMaterial { name: name.to_owned(), surface });
        MeshFault::check_materials(materials.len())?;
    }
    Ok(materials)
}

/// Returns the value of a statement; `None` for another statement.
fn value_of<'a>(line: &'a str, keyword: &str) -> Option<&'a str> {
    let rest = line.trim_start().strip_prefix(keyword)?;
    rest.starts_with(char::is_whitespace).then(|| rest.trim())
}

fn text_of(bytes: &[u8]) -> Result<&str, MeshFault> {
    std::str::from_utf8(bytes).map_err(|_| MeshFault::new("which is no text", "UTF-8"))
}

/// Returns the statements that `tobj` reads: line number, counted from 1, and text with the end of line.
fn statements(text: &str) -> Result<Vec<(usize, &str)>, MeshFault> {
    let mut kept = Vec::new();
    for (line, content) in (1..).zip(text.split_inclusive('\n')) {
        let mut words = content.split_whitespace();
        let keyword = words.next().unwrap_or_default();
        if NO_POLYGONS.contains(&keyword) {
            let fault = format!("line {line} of which is a statement `{keyword}`");
            return Err(MeshFault::new(
                fault,
                "polygons only: no points, lines, curves or free-form surfaces",
            ));
        }
        if content.trim_end().ends_with('\\') {
            let fault = format!("line {line} of which goes on in the next line");
            return Err(MeshFault::new(fault, "a statement per line"));
        }
        if keyword == "v" && words.count() > 4 {
            let fault = format!("line {line} of which has a colour of a corner");
            return Err(MeshFault::new(fault, "corners without colours: colours are those of materials"));
        }
        if ["v", "f", "usemtl"].contains(&keyword) {
            kept.push((line, content));
        }
    }
    Ok(kept)
}

/// Reader of the kept statements that records the line being read.
struct Statements<'a> {
    statements: &'a [(usize, &'a str)],
    rest: &'a [u8],
    next: usize,
    line: &'a Cell<usize>,
}

impl Read for Statements<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let length = self.fill_buf()?.read(buffer)?;
        self.consume(length);
        Ok(length)
    }
}

impl BufRead for Statements<'_> {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        if let (true, Some((line, content))) = (self.rest.is_empty(), self.statements.get(self.next)) {
            self.rest = content.as_bytes();
            self.line.set(*line);
            self.next += 1;
        }
        Ok(self.rest)
    }

    fn consume(&mut self, length: usize) {
        self.rest = self.rest.get(length..).unwrap_or_default();
    }
}

/// Returns the fault of an error of `tobj`; `line` is the line that was read last.
fn explain(error: LoadError, line: usize) -> MeshFault {
    match error {
        LoadError::FaceVertexOutOfBounds => MeshFault::new(
            format!("a face of which, before line {}, has an index out of range", line + 1),
            "indices from 1 to the number of corners, or from -1 down",
        ),
        LoadError::FaceParseError => MeshFault::new(
            format!("line {line} of which is no face"),
            "`f` and the indices of three or more corners",
        ),
        LoadError::PositionParseError | LoadError::ScalingByZeroError | LoadError::ColorParseError => {
            MeshFault::new(format!("line {line} of which is no corner"), "`v` and three numbers")
        }
        other => MeshFault::new(format!("line {line} of which is wrong ({other})"), "a Wavefront OBJ file"),
    }
}

/// Adds the polygons of a part of the file, each as a fan of triangles from its first corner.
fn add_polygons(mesh: &mut FileMesh, part: &tobj::Mesh) -> Result<(), MeshFault> {
    let corner = |index: &u32| match part.positions.get(3 * *index as usize..3 * *index as usize + 3) {
        Some([x, y, z]) => Ok(Vector3::new(*x, *y, *z)),
        _ => Err(MeshFault::new("a face of which has an index out of range", "indices of corners")),
    };
    // The list of side counts is empty for triangles only.
    let triangles = part.indices.len() / 3;
    let sides: Vec<usize> = match &part.face_arities[..] {
        [] => vec![3; triangles],
        sides => sides.iter().map(|count| *count as usize).collect(),
    };
    let mut start = 0;
    for count in sides {
        let corners: Vec<Vector3<f64>> = part
            .indices
            .get(start..start + count)
            .unwrap_or_default()
            .iter()
            .map(corner)
            .collect::<Result<_, _>>()?;
        start += count;
        let ([first, rest @ ..], true) = (&corners[..], corners.len() >= 3) else {
            let fault = format!("a face of which has {} corners", corners.len());
            return Err(MeshFault::new(fault, "three corners or more"));
        };
        let fan = rest.windows(2).filter_map(|pair| match pair {
            [second, third] => Some([*first, *second, *third]),
            _ => None,
        });
        let fan: Vec<_> = fan.collect();
        check_convex(&fan)?;
        mesh.material_of.extend(std::iter::repeat_n(part.material_id, fan.len()));
        mesh.triangles.extend(fan);
    }
    Ok(())
}

/// Checks that the triangles of a fan do not fold back: the polygon is flat enough and seen convex from its
/// first corner.
fn check_convex(fan: &[[Vector3<f64>; 3]]) -> Result<(), MeshFault> {
    let area = |[a, b, c]: &[Vector3<f64>; 3]| (b - a).cross(&(c - a));
    let whole: Vector3<f64> = fan.iter().map(area).sum();
    match fan.iter().find(|triangle| area(triangle).dot(&whole) < 0.0) {
        Some([first, ..]) => Err(MeshFault::new(
            format!("a face of which, at {}, is not convex", super::shown(first)),
            "convex polygons: triangulate the mesh",
        )),
        None => Ok(()),
    }
}
