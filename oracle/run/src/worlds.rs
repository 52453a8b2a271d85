//! Registry of worlds.

use std::collections::HashMap;
use std::sync::{LazyLock, PoisonError, RwLock};

use config::toml_file;
use files::Failure;
use schemars::{Schema, SchemaGenerator, json_schema};
use score::{FigureSpec, navigation_figures};

use crate::any_world::AnyWorld;

/// Registered worlds, in order.
static REGISTERED: RwLock<Vec<&'static dyn AnyWorld>> = RwLock::new(Vec::new());

/// Figures of all worlds and of the navigation, by key.
static FIGURES: LazyLock<RwLock<HashMap<String, FigureSpec>>> =
    LazyLock::new(|| RwLock::new(of_navigation().collect()));

/// Figures of the relative navigation, which is a step after a run.
fn of_navigation() -> impl Iterator<Item = (String, FigureSpec)> {
    navigation_figures().into_iter().map(|figure| (figure.name.clone(), figure))
}

/// Registers a world for the rest of the process, as in `register(&ErasedWorld::<MyWorld>::NEW)`: every
/// command, study and gate then supports it. The first registered world is that of scenarios that name none.
/// A world that is registered already is left as it is.
pub fn register(world: &'static dyn AnyWorld) {
    if worlds().contains(&world) {
        return;
    }
    register_figures(world.figures());
    REGISTERED.write().unwrap_or_else(PoisonError::into_inner).push(world);
}

/// Registers figures, by their keys, for the rest of the process.
pub fn register_figures(figures: Vec<FigureSpec>) {
    let mut known = FIGURES.write().unwrap_or_else(PoisonError::into_inner);
    known.extend(figures.into_iter().map(|figure| (figure.name.clone(), figure)));
}

/// Returns the figure with this key, of any world; [`FigureSpec::unknown`] for a key that no world has.
pub fn figure_by_name(key: &str) -> FigureSpec {
    let figures = FIGURES.read().unwrap_or_else(PoisonError::into_inner);
    figures.get(key).cloned().unwrap_or_else(|| FigureSpec::unknown(key))
}

/// Returns all worlds.
pub fn worlds() -> Vec<&'static dyn AnyWorld> {
    let registered = REGISTERED.read().unwrap_or_else(PoisonError::into_inner);
    registered.clone()
}

/// Returns the world of scenarios that name none.
///
/// # Errors
/// [`Failure::Usage`] if no world is registered.
pub fn first_world() -> Result<&'static dyn AnyWorld, Failure> {
    let no_world = || Failure::Usage("no world is registered in this process".to_owned());
    worlds().first().copied().ok_or_else(no_world)
}

/// Returns the world with this code.
///
/// # Errors
/// A message that names the unknown code and the existing ones.
pub fn world_by_name(word: &str) -> Result<&'static dyn AnyWorld, String> {
    let worlds = worlds();
    worlds.iter().copied().find(|world| world.code() == word).ok_or_else(|| {
        let codes: Vec<&str> = worlds.iter().map(|world| world.code()).collect();
        let hint = toml_file::nearest(word, codes.iter().copied())
            .map_or(String::new(), |name| format!("; did you mean `{name}`?"));
        let expected: Vec<String> = codes.iter().map(|code| format!("`{code}`")).collect();
        format!("unknown world `{word}`, expected {}{hint}", expected.join(" or "))
    })
}

/// Returns the JSON Schema of the scenario files of one world, or of all worlds without one, derived from the
/// types that read them.
pub fn json_schema(world: Option<&dyn AnyWorld>) -> Schema {
    let mut generator = SchemaGenerator::default();
    match world {
        Some(world) => world.schema(generator),
        None => {
            let kinds: Vec<Schema> =
                worlds().into_iter().map(|world| world.subschema(&mut generator)).collect();
            json_schema!({
                "$schema": generator.settings().meta_schema.as_deref(),
                "title": "Scenario",
                "description": "A scenario file: of one world, by its key `world`.",
                "anyOf": kinds,
                "$defs": generator.take_definitions(true),
            })
        }
    }
}
