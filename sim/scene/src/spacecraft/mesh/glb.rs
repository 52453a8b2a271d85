//! Meshes in binary glTF 2.0, parsed by `gltf`.
//!
//! Positions and indices are read here, with every bound checked: the crate's own readers trust the file.

use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Mode;
use gltf::scene::Transform;
use gltf::{Accessor, Document, Gltf, Material, Node, Primitive, Semantic};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use super::material::{FileMaterial, from_metallic_roughness};
use super::{FileMesh, MAX_TRIANGLES, MeshFault};

/// Extension of all lights, which have no effect on a mesh.
const LIGHTS: &str = "KHR_lights_punctual";
/// Beginning of the names of extensions of materials, which have an effect only on the materials of the file.
const OF_MATERIALS: [&str; 2] = ["KHR_materials_", "KHR_texture_"];
/// Maximum depth of the tree of nodes, and maximum number of nodes that are visited.
const MAX_DEPTH: usize = 64;
const MAX_NODES: usize = 10_000;
/// Maximum number of corners of all primitives.
const MAX_CORNERS: usize = 20 * MAX_TRIANGLES;
/// Length of the header of a file and of that of a chunk, bytes.
const HEADER: usize = 12;

/// Reads a mesh: the default scene, or else the first.
///
/// # Errors
/// A [`MeshFault`] for the first fault of the file.
pub(super) fn read(bytes: &[u8]) -> Result<FileMesh, MeshFault> {
    let gltf = parse(bytes)?;
    let data = gltf.blob.as_deref().unwrap_or_default();
    let document = &gltf.document;
    check_features(document)?;
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let scene = scene.ok_or_else(|| MeshFault::new("without a scene", "a scene with a mesh"))?;
    MeshFault::check_materials(document.materials().len())?;
    let extension = document.extensions_used().find(|name| name.starts_with(OF_MATERIALS[0]));
    let materials = document.materials().map(|material| FileMaterial {
        name: material.name().unwrap_or_default().to_owned(),
        surface: surface(&material, extension),
    });
    let mut reader = Reader {
        data,
        mesh: FileMesh { materials: materials.collect(), ..FileMesh::default() },
        nodes: 0,
        corners: 0,
    };
    for node in scene.nodes() {
        reader.add(&node, &Placement::identity(), 0)?;
    }
    Ok(reader.mesh)
}

/// Parses the file. The references that the crate's own validation follows unchecked are checked before.
fn parse(bytes: &[u8]) -> Result<Gltf, MeshFault> {
    let expected = "binary glTF 2.0";
    let length = bytes.get(8..HEADER).and_then(|field| field.try_into().ok()).map_or(0, u32::from_le_bytes);
    if !bytes.starts_with(b"glTF") || (length as usize) < HEADER {
        return Err(MeshFault::new("which does not begin as a .glb file", expected));
    }
    let unreadable = |error: gltf::Error| MeshFault::new(format!("which cannot be read ({error})"), expected);
    let Gltf { document, blob } = Gltf::from_slice_without_validation(bytes).map_err(unreadable)?;
    let root = document.into_json();
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut accessors = primitives.flat_map(|primitive| primitive.attributes.values());
    if accessors.any(|accessor| accessor.value() >= root.accessors.len()) {
        return Err(MeshFault::new("which refers to an accessor that it does not have", expected));
    }
    let document = Document::from_json(root).map_err(unreadable)?;
    Ok(Gltf { document, blob })
}

/// Refuses features that would change the shape.
fn check_features(document: &Document) -> Result<(), MeshFault> {
    let refuse = |feature: String| {
        Err(MeshFault::new(format!("with {feature}"), "a mesh at rest: export it without this"))
    };
    if document.animations().len() > 0 {
        return refuse("animations".to_owned());
    }
    if document.skins().len() > 0 {
        return refuse("skins".to_owned());
    }
    let harmless =
        |name: &str| name == LIGHTS || OF_MATERIALS.iter().any(|beginning| name.starts_with(beginning));
    match document.extensions_used().find(|name| !harmless(name)) {
        Some(name) => refuse(format!("the extension {name}")),
        None => Ok(()),
    }
}

/// Returns the reflectance of a material, or its unsupported property. `extension` is an extension of
/// materials that the file uses somewhere.
fn surface(material: &Material<'_>, extension: Option<&str>) -> Result<super::SurfaceConfig, String> {
    let model = material.pbr_metallic_roughness();
    let has_texture = model.base_color_texture().is_some()
        || model.metallic_roughness_texture().is_some()
        || material.normal_texture().is_some()
        || material.occlusion_texture().is_some()
        || material.emissive_texture().is_some();
    let [red, green, blue, _] = model.base_color_factor().map(f64::from);
    if has_texture {
        Err("it has a texture".to_owned())
    } else if material.emissive_factor() != [0.0; 3] {
        Err("it emits light (emissiveFactor)".to_owned())
    } else if material.alpha_mode() != gltf::material::AlphaMode::Opaque {
        Err("it is transparent (alphaMode)".to_owned())
    } else if let Some(extension) = extension {
        Err(format!("the file uses the extension {extension}"))
    } else {
        from_metallic_roughness(
            [red, green, blue],
            model.metallic_factor().into(),
            model.roughness_factor().into(),
        )
    }
}

/// Position, orientation and size of a node in the scene: x ↦ M x + t.
struct Placement {
    matrix: Matrix3<f64>,
    offset: Vector3<f64>,
}

impl Placement {
    fn identity() -> Self {
        Self { matrix: Matrix3::identity(), offset: Vector3::zeros() }
    }

    /// Returns the placement of a node inside this one.
    fn of_child(&self, node: &Node<'_>) -> Self {
        let (matrix, offset) = match node.transform() {
            Transform::Matrix { matrix: [x, y, z, offset] } => {
                let [x, y, z, offset] =
                    [x, y, z, offset].map(|[a, b, c, _]| Vector3::new(a, b, c).cast::<f64>());
                (Matrix3::from_columns(&[x, y, z]), offset)
            }
            Transform::Decomposed { translation, rotation: [x, y, z, w], scale } => {
                let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z).cast::<f64>());
                let scale = Matrix3::from_diagonal(&Vector3::from(scale).cast::<f64>());
                (turn.to_rotation_matrix().into_inner() * scale, Vector3::from(translation).cast::<f64>())
            }
        };
        Self { matrix: self.matrix * matrix, offset: self.matrix * offset + self.offset }
    }
}

/// Triangles read so far.
struct Reader<'a> {
    data: &'a [u8],
    mesh: FileMesh,
    nodes: usize,
    corners: usize,
}

impl Reader<'_> {
    /// Adds the meshes of a node and of its children.
    fn add(&mut self, node: &Node<'_>, parent: &Placement, depth: usize) -> Result<(), MeshFault> {
        self.nodes += 1;
        if depth > MAX_DEPTH || self.nodes > MAX_NODES {
            return Err(MeshFault::new(
                "whose tree of nodes is too large or has a circle",
                "at most 10000 nodes, 64 deep",
            ));
        }
        let placement = parent.of_child(node);
        for primitive in node.mesh().into_iter().flat_map(|mesh| mesh.primitives()) {
            self.add_primitive(&primitive, &placement)?;
        }
        for child in node.children() {
            self.add(&child, &placement, depth + 1)?;
        }
        Ok(())
    }

    fn add_primitive(&mut self, primitive: &Primitive<'_>, placement: &Placement) -> Result<(), MeshFault> {
        if primitive.mode() != Mode::Triangles {
            let fault = format!("with a primitive of the mode {:?}", primitive.mode());
            return Err(MeshFault::new(fault, "triangles only: no points, lines, strips or fans"));
        }
        if primitive.morph_targets().len() > 0 {
            return Err(MeshFault::new("with morph targets", "a mesh at rest: export it without this"));
        }
        let has_colours = primitive.attributes().any(|(semantic, _)| matches!(semantic, Semantic::Colors(_)));
        if has_colours {
            return Err(MeshFault::new(
                "with colours of corners",
                "corners without colours: colours are those of materials",
            ));
        }
        let accessor = primitive.get(&Semantic::Positions);
        let accessor =
            accessor.ok_or_else(|| MeshFault::new("with a primitive without positions", "positions"))?;
        self.corners = self.corners.saturating_add(accessor.count());
        if self.corners > MAX_CORNERS {
            let fault = format!("with more than {MAX_CORNERS} corners");
            return Err(MeshFault::new(fault, "at most 10000 triangles: simplify it"));
        }
        let place = |at: Vector3<f64>| placement.matrix * at + placement.offset;
        let corners: Vec<Vector3<f64>> = self.positions(&accessor)?.into_iter().map(place).collect();
        let count = primitive.indices().map_or(corners.len(), |accessor| accessor.count());
        if count / 3 + self.mesh.triangles.len() > 2 * MAX_TRIANGLES {
            let fault = format!("a mesh of more than {} triangles", 2 * MAX_TRIANGLES);
            return Err(MeshFault::new(fault, "at most 10000 triangles: simplify it"));
        }
        let indices = match primitive.indices() {
            Some(accessor) => self.indices(&accessor)?,
            None => (0..corners.len()).collect(),
        };
        // A reflection reverses the order of the corners.
        let is_reflected = placement.matrix.determinant() < 0.0;
        for triangle in indices.as_chunks::<3>().0 {
            let [Some(a), Some(b), Some(c)] = triangle.map(|index| corners.get(index).copied()) else {
                let fault = format!("with an index out of range, {triangle:?} of {} corners", corners.len());
                return Err(MeshFault::new(fault, "indices below the number of corners"));
            };
            self.mesh.triangles.push(if is_reflected { [a, c, b] } else { [a, b, c] });
            self.mesh.material_of.push(primitive.material().index());
        }
        Ok(())
    }

    fn positions(&self, accessor: &Accessor<'_>) -> Result<Vec<Vector3<f64>>, MeshFault> {
        if (accessor.data_type(), accessor.dimensions()) != (DataType::F32, Dimensions::Vec3) {
            return Err(MeshFault::new(
                "with positions that are not three 32-bit numbers each",
                "positions as VEC3 of float",
            ));
        }
        let number =
            |bytes: &[u8]| bytes.try_into().map_or(f64::NAN, |bytes| f64::from(f32::from_le_bytes(bytes)));
        let items = self.items(accessor, 12)?;
        Ok(items.map(|item| Vector3::from_iterator(item.chunks(4).map(number))).collect())
    }

    fn indices(&self, accessor: &Accessor<'_>) -> Result<Vec<usize>, MeshFault> {
        let size = match (accessor.data_type(), accessor.dimensions()) {
            (DataType::U8, Dimensions::Scalar) => 1,
            (DataType::U16, Dimensions::Scalar) => 2,
            (DataType::U32, Dimensions::Scalar) => 4,
            _ => {
                return Err(MeshFault::new("with indices that are no unsigned integers", "8, 16 or 32 bits"));
            }
        };
        let number = |bytes: &[u8]| bytes.iter().rev().fold(0, |sum, byte| (sum << 8) | usize::from(*byte));
        Ok(self.items(accessor, size)?.map(number).collect())
    }

    /// Returns the items of an accessor, each of `size` bytes.
    fn items(&self, accessor: &Accessor<'_>, size: usize) -> Result<impl Iterator<Item = &[u8]>, MeshFault> {
        if accessor.sparse().is_some() {
            return Err(MeshFault::new("with a sparse accessor", "complete lists of positions and indices"));
        }
        let fault =
            || MeshFault::new("with an accessor beyond its data", "data inside the file's own buffer");
        let view = accessor.view().ok_or_else(fault)?;
        if view.buffer().index() != 0 || !matches!(view.buffer().source(), gltf::buffer::Source::Bin) {
            return Err(MeshFault::new("with data in another file or as text", "all data in the .glb file"));
        }
        let stride = view.stride().unwrap_or(size).max(1);
        let end = view.offset().checked_add(view.length()).ok_or_else(fault)?;
        let view = self.data.get(view.offset()..end).ok_or_else(fault)?;
        let items = view.get(accessor.offset()..).ok_or_else(fault)?;
        let count = accessor.count();
        // The last item may end before the end of its stride.
        let needed = count.checked_sub(1).and_then(|last| last.checked_mul(stride)?.checked_add(size));
        if needed.is_none_or(|needed| needed > items.len()) {
            return Err(fault());
        }
        Ok((0..count).filter_map(move |index| items.get(index * stride..index * stride + size)))
    }
}
