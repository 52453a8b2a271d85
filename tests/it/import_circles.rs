//! No two files of a crate depend on each other: their common items are in a third file.
//!
//! A file depends on another when its code names an item that the other defines, through any import or
//! re-export. A file that only declares modules on the way to an item is not a dependency. Dependencies
//! through method calls only are not detected.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use cargo_metadata::Target;
use pathfinding::prelude::strongly_connected_components;
use syn::visit::{self, Visit};
use syn::{Attribute, Expr, ExprLit, Ident, ImplItemFn, Item, ItemUse, Lit, Macro, PatIdent, UseTree};

/// Index of a module of a crate.
type ModuleId = usize;

/// Meaning of a name in a module.
enum Meaning {
    /// An item that the module's file defines.
    Item,
    Module(ModuleId),
    /// Another name, introduced by a `use`.
    Alias(Vec<String>),
}

/// Target of a path.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum PathTarget {
    Module(ModuleId),
    /// An item that the file of this module defines.
    Item(ModuleId),
}

impl PathTarget {
    fn is_module(&self) -> bool {
        matches!(self, Self::Module(_))
    }
}

/// A module: a file, or a part of a file.
#[derive(Default)]
struct Module {
    parent: Option<ModuleId>,
    file: PathBuf,
    names: BTreeMap<String, Vec<Meaning>>,
    /// Paths with all names imported (`use a::b::*`).
    globs: Vec<Vec<String>>,
    /// Paths that the code of the module names, including those that it only re-exports (`pub use`).
    mentions: BTreeSet<Vec<String>>,
    /// Names of the variables of the item being read.
    variables: BTreeSet<String>,
}

/// Modules of a crate, the first of which is the root. Code of unit tests is excluded.
struct Crate {
    modules: Vec<Module>,
}

impl Crate {
    fn read(root: &Path) -> Self {
        let mut tree = Self { modules: Vec::new() };
        let folder = root.parent().expect("a root is in a folder").to_owned();
        tree.read_file(None, root, &folder);
        tree
    }

    fn read_file(&mut self, parent: Option<ModuleId>, file: &Path, folder: &Path) -> ModuleId {
        let text =
            std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let items =
            syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display())).items;
        self.read_items(parent, file, folder, &items)
    }

    /// Reads a module. The files of the modules that it declares are in `folder`.
    fn read_items(
        &mut self,
        parent: Option<ModuleId>,
        file: &Path,
        folder: &Path,
        items: &[Item],
    ) -> ModuleId {
        let id = self.modules.len();
        self.modules.push(Module { parent, file: file.to_owned(), ..Module::default() });
        for item in items {
            let (name, attributes) = name_and_attributes(item);
            if is_test(attributes) {
                continue;
            }
            let meaning = match item {
                Item::Mod(module) => {
                    let folder = folder.join(module.ident.to_string());
                    Meaning::Module(match &module.content {
                        Some((_, items)) => self.read_items(Some(id), file, &folder, items),
                        None if let Some(path) = path_attribute(attributes) => {
                            let file = file.with_file_name(path);
                            self.read_file(Some(id), &file, &folder)
                        }
                        None => {
                            let beside = folder.with_extension("rs");
                            let file = if beside.is_file() { beside } else { folder.join("mod.rs") };
                            self.read_file(Some(id), &file, &folder)
                        }
                    })
                }
                _ => Meaning::Item,
            };
            let module = &mut self.modules[id];
            if let Some(name) = name {
                module.names.entry(name.to_string()).or_default().push(meaning);
            }
            if !matches!(item, Item::Mod(_)) {
                module.read_item(item);
            }
        }
        id
    }

    /// Resolves a path in the code of the module `from` to its targets.
    fn resolve(
        &self,
        from: ModuleId,
        path: &[String],
        seen: &mut BTreeSet<(ModuleId, String)>,
    ) -> BTreeSet<PathTarget> {
        let mut targets = BTreeSet::from([PathTarget::Module(from)]);
        for (index, segment) in path.iter().enumerate() {
            let step = |target| match target {
                PathTarget::Item(_) => BTreeSet::from([target]),
                PathTarget::Module(module) => match segment.as_str() {
                    "crate" => BTreeSet::from([PathTarget::Module(0)]),
                    "self" => BTreeSet::from([target]),
                    "super" => self.modules[module].parent.map(PathTarget::Module).into_iter().collect(),
                    name => self.look_up(module, name, seen),
                },
            };
            targets = targets.into_iter().flat_map(step).collect();
            // A function may have the name of a module; only a module can be followed by another segment.
            if index + 1 < path.len() && targets.iter().any(PathTarget::is_module) {
                targets.retain(PathTarget::is_module);
            }
        }
        targets
    }

    /// Resolves a name to its definition. A name defined in another crate has no target.
    fn look_up(
        &self,
        module: ModuleId,
        name: &str,
        seen: &mut BTreeSet<(ModuleId, String)>,
    ) -> BTreeSet<PathTarget> {
        if !seen.insert((module, name.to_owned())) {
            return BTreeSet::new();
        }
        let Module { names, globs, .. } = &self.modules[module];
        let mut targets = BTreeSet::new();
        for meaning in names.get(name).into_iter().flatten() {
            match meaning {
                Meaning::Item => _ = targets.insert(PathTarget::Item(module)),
                Meaning::Module(child) => _ = targets.insert(PathTarget::Module(*child)),
                Meaning::Alias(path) => targets.extend(self.resolve(module, path, &mut seen.clone())),
            }
        }
        if targets.is_empty() {
            for path in globs {
                for target in self.resolve(module, path, &mut seen.clone()) {
                    if let PathTarget::Module(other) = target {
                        targets.extend(self.look_up(other, name, seen));
                    }
                }
            }
        }
        targets
    }

    /// Returns for each file the files that it depends on, each with the paths that lead there.
    fn arrows(&self) -> BTreeMap<&Path, BTreeMap<&Path, BTreeSet<String>>> {
        let mut arrows: BTreeMap<_, BTreeMap<_, BTreeSet<_>>> = BTreeMap::new();
        for (id, module) in self.modules.iter().enumerate() {
            let targets = arrows.entry(module.file.as_path()).or_default();
            for path in &module.mentions {
                for target in self.resolve(id, path, &mut BTreeSet::new()) {
                    // A module is only a part of a path: the item is named after it.
                    let PathTarget::Item(owner) = target else { continue };
                    let owner = self.modules[owner].file.as_path();
                    if owner != module.file {
                        targets.entry(owner).or_default().insert(path.join("::"));
                    }
                }
            }
        }
        arrows
    }

    /// Returns the dependency cycles, each as lines that state which file depends on which items of which
    /// other file.
    fn circles(&self) -> Vec<String> {
        let arrows = self.arrows();
        let files: Vec<&Path> = arrows.keys().copied().collect();
        let groups =
            strongly_connected_components(&files, |file| arrows[file].keys().copied().collect::<Vec<_>>());
        let folder = self.modules[0].file.parent().expect("a root is in a folder");
        let short = |file: &Path| file.strip_prefix(folder).unwrap_or(file).display().to_string();
        let describe = |group: Vec<&Path>| {
            let mut text = format!("{}: {} files\n", folder.display(), group.len());
            for from in &group {
                for (to, paths) in arrows[from].iter().filter(|(to, _)| group.contains(to)) {
                    let paths: Vec<&str> = paths.iter().map(String::as_str).collect();
                    text += &format!("    {} -> {}: {}\n", short(from), short(to), paths.join(", "));
                }
            }
            text
        };
        groups.into_iter().filter(|group| group.len() > 1).map(describe).collect()
    }
}

impl Module {
    fn read_item(&mut self, item: &Item) {
        let before = std::mem::take(&mut self.mentions);
        self.visit_item(item);
        let variables = std::mem::take(&mut self.variables);
        let is_variable = |path: &[String]| matches!(path, [only] if variables.contains(only));
        self.mentions.retain(|path| !is_variable(path));
        self.mentions.extend(before);
    }
}

/// Collects the names in a module's code.
impl<'ast> Visit<'ast> for Module {
    fn visit_attribute(&mut self, attribute: &'ast Attribute) {
        if let syn::Meta::List(list) = &attribute.meta {
            // serde names functions in strings.
            let paths = paths_in(&list.tokens.to_string());
            self.mentions.extend(paths.into_iter().filter(|path| path.len() > 1));
        }
    }

    fn visit_impl_item_fn(&mut self, function: &'ast ImplItemFn) {
        if !is_test(&function.attrs) {
            visit::visit_impl_item_fn(self, function);
        }
    }

    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        let mut trees = vec![(Vec::new(), &item.tree)];
        while let Some((mut path, tree)) = trees.pop() {
            let (last, name) = match tree {
                UseTree::Path(tree) => {
                    path.push(tree.ident.to_string());
                    trees.push((path, &tree.tree));
                    continue;
                }
                UseTree::Group(group) => {
                    trees.extend(group.items.iter().map(|tree| (path.clone(), tree)));
                    continue;
                }
                UseTree::Glob(_) => {
                    self.mentions.insert(path.clone());
                    self.globs.push(path);
                    continue;
                }
                UseTree::Name(tree) if tree.ident == "self" => {
                    let name = path.last().expect("`self` is inside of a group").clone();
                    (None, name)
                }
                UseTree::Name(tree) => (Some(tree.ident.to_string()), tree.ident.to_string()),
                UseTree::Rename(tree) => (Some(tree.ident.to_string()), tree.rename.to_string()),
            };
            path.extend(last);
            self.mentions.insert(path.clone());
            self.names.entry(name).or_default().push(Meaning::Alias(path));
        }
    }

    fn visit_pat_ident(&mut self, pattern: &'ast PatIdent) {
        // Names in upper case are constants.
        let name = pattern.ident.to_string();
        if name.starts_with(char::is_lowercase) {
            self.variables.insert(name);
        }
        visit::visit_pat_ident(self, pattern);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.mentions.insert(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast Macro) {
        self.visit_path(&call.path);
        self.mentions.extend(paths_in(&call.tokens.to_string()));
    }
}

/// Returns the paths in a text of tokens, including single names.
fn paths_in(tokens: &str) -> Vec<Vec<String>> {
    let text = tokens.replace(" ::", "::").replace(":: ", "::");
    let words = text.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':'));
    let words = words.map(|word| word.trim_matches(':')).filter(|word| !word.is_empty());
    words.map(|word| word.split("::").map(str::to_owned).collect()).collect()
}

/// Returns the path in `#[path = "..."]`.
fn path_attribute(attributes: &[Attribute]) -> Option<String> {
    let mut pairs = attributes.iter().filter_map(|attribute| attribute.meta.require_name_value().ok());
    let value = pairs.find(|pair| pair.path.is_ident("path")).map(|pair| &pair.value);
    match value {
        Some(Expr::Lit(ExprLit { lit: Lit::Str(path), .. })) => Some(path.value()),
        _ => None,
    }
}

/// Returns true for code that is compiled only for unit tests.
fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        syn::Meta::List(list) if list.path.is_ident("cfg") => {
            let condition = list.tokens.to_string();
            condition == "test" || condition.starts_with("all") && condition.contains("test")
        }
        _ => false,
    })
}

/// Returns the name of an item in its module, and its attributes.
fn name_and_attributes(item: &Item) -> (Option<&Ident>, &[Attribute]) {
    match item {
        Item::Const(item) => (Some(&item.ident), &item.attrs),
        Item::Enum(item) => (Some(&item.ident), &item.attrs),
        Item::Fn(item) => (Some(&item.sig.ident), &item.attrs),
        Item::Impl(item) => (None, &item.attrs),
        Item::Macro(item) => (item.ident.as_ref(), &item.attrs),
        Item::Mod(item) => (Some(&item.ident), &item.attrs),
        Item::Static(item) => (Some(&item.ident), &item.attrs),
        Item::Struct(item) => (Some(&item.ident), &item.attrs),
        Item::Trait(item) => (Some(&item.ident), &item.attrs),
        Item::Type(item) => (Some(&item.ident), &item.attrs),
        Item::Union(item) => (Some(&item.ident), &item.attrs),
        Item::Use(item) => (None, &item.attrs),
        _ => (None, &[]),
    }
}

/// Returns the root files of all libraries and programs of the workspace.
fn roots() -> Vec<PathBuf> {
    let is_product = |target: &&Target| target.is_lib() || target.is_cdylib() || target.is_bin();
    let packages = super::architecture::workspace().packages;
    let roots = packages.iter().flat_map(|package| package.targets.iter().filter(is_product));
    roots.map(|target| target.src_path.clone().into_std_path_buf()).collect()
}

#[test]
fn no_file_needs_a_file_that_needs_it() {
    let roots = roots();
    assert!(roots.len() > 20, "{} crates were found, expected those of the workspace", roots.len());
    let circles: Vec<String> = roots.iter().flat_map(|root| Crate::read(root).circles()).collect();
    assert!(circles.is_empty(), "move what the files share into a file of its own:\n{}", circles.join(""));
}

/// Returns the dependency cycles of a crate with these files.
fn circles_of(files: &[(&str, &str)]) -> Vec<String> {
    let folder = tempfile::tempdir().expect("a temporary directory");
    for (name, text) in files {
        let file = folder.path().join(name);
        std::fs::create_dir_all(file.parent().expect("a folder")).expect("made");
        std::fs::write(file, text).expect("written");
    }
    let circles = Crate::read(&folder.path().join("lib.rs")).circles();
    circles
        .into_iter()
        .map(|circle| circle.lines().skip(1).map(str::trim).collect::<Vec<_>>().join("; "))
        .collect()
}

#[test]
fn a_circle_is_found_however_it_is_written() {
    let lib = ("lib.rs", "mod a;\nmod b;\npub use a::A;\npub use b::B;\n");
    let a = ("a.rs", "use crate::{b, c as _, b::{self as other}};\npub struct A(b::B);\n");
    let ways = [
        "use super::A;\npub struct B(Box<A>);",
        "use super::a::*;\npub struct B(Box<A>);",
        "pub struct B(Box<crate::a::A>);",
        "pub struct B;\nfn all() -> usize { vec![crate::A::COUNT].len() }",
        "pub struct B;\nmod inner { use super::super::A; pub struct C(A); }",
        "#[serde(with = \"super::a::bytes\")]\npub struct B;",
    ];
    for way in ways {
        let a = if way.contains("bytes") {
            ("a.rs", "pub mod bytes {}\npub fn bytes(_: super::B) {}")
        } else {
            a
        };
        let circles = circles_of(&[lib, a, ("b.rs", way)]);
        assert_eq!(circles.len(), 1, "{way}");
        assert!(circles[0].contains("a.rs -> b.rs") && circles[0].contains("b.rs -> a.rs"), "{circles:?}");
    }
}

#[test]
fn tables_of_contents_tests_and_variables_make_no_circle() {
    let lib = ("lib.rs", "pub mod a;\nmod b;\npub use b::B;\n");
    let a = ("a/mod.rs", "mod low;\nmod high;\npub use high::{High, level};\npub use low::Low;\n");
    let low = ("a/low.rs", "pub struct Low;\n#[cfg(test)]\nmod tests { use super::super::High; }\n");
    let high = ("a/high.rs", "use super::Low;\npub struct High(Low, crate::B);\npub fn level() {}\n");
    let b = ("b.rs", "use crate::a::*;\npub struct B(crate::a::Low);\nfn of(level: u8) -> u8 { level }\n");
    assert_eq!(circles_of(&[lib, a, low, high, b]), Vec::<String>::new());
}
