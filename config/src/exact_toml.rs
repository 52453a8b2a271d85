//! Strict TOML reader. The crate `toml` drops the elements of an array beyond the length of its type, and
//! accepts an array instead of a table if its values are in the order of a struct's fields; serde leaves both
//! decisions to the format. Here both are errors, with their position.

use std::fmt;

use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error, Expected, IgnoredAny, MapAccess,
    SeqAccess, Unexpected, VariantAccess, Visitor,
};

/// Parses a text as `T`: an array of fixed length must have exactly its number of values, and a table must be
/// written as a table.
///
/// # Errors
/// Those of [`toml::from_str`], and an error for values that it would drop or accept as a table.
pub fn from_str<T: DeserializeOwned>(text: &str) -> Result<T, toml::de::Error> {
    T::deserialize(StrictReader(toml::Deserializer::parse(text)?))
}

/// Wrapper of one part of the deserialisation, around that of `toml` or of a type.
struct StrictReader<X>(X);

impl<'de, D: Deserializer<'de>> Deserializer<'de> for StrictReader<D> {
    type Error = D::Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        self.0.deserialize_any(ShapeVisitor(visitor, Shape::Any))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        self.0.deserialize_option(ShapeVisitor(visitor, Shape::Any))
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, D::Error> {
        self.0.deserialize_newtype_struct(name, ShapeVisitor(visitor, Shape::Any))
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, len: usize, visitor: V) -> Result<V::Value, D::Error> {
        self.0.deserialize_tuple(len, ShapeVisitor(visitor, Shape::Array(len)))
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        len: usize,
        visitor: V,
    ) -> Result<V::Value, D::Error> {
        self.0.deserialize_tuple_struct(name, len, ShapeVisitor(visitor, Shape::Array(len)))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, D::Error> {
        self.0.deserialize_struct(name, fields, ShapeVisitor(visitor, Shape::Table))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, D::Error> {
        self.0.deserialize_enum(name, variants, ShapeVisitor(visitor, Shape::Any))
    }

    // TOML determines these types by itself.
    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq map identifier ignored_any
    }
}

/// Required form of a type in TOML.
#[derive(Clone, Copy)]
enum Shape {
    Any,
    /// Array with this number of values.
    Array(usize),
    Table,
}

/// Visitor of a type that checks the form of its values.
struct ShapeVisitor<V>(V, Shape);

macro_rules! delegate {
    ($($method:ident: $value:ty),*) => {
        $(fn $method<E: Error>(self, value: $value) -> Result<V::Value, E> {
            self.0.$method(value)
        })*
    };
}

impl<'de, V: Visitor<'de>> Visitor<'de> for ShapeVisitor<V> {
    type Value = V::Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.expecting(f)
    }

    delegate! {
        visit_bool: bool, visit_i64: i64, visit_i128: i128, visit_u64: u64, visit_u128: u128, visit_f64: f64,
        visit_str: &str, visit_borrowed_str: &'de str, visit_string: String
    }

    fn visit_some<D: Deserializer<'de>>(self, value: D) -> Result<V::Value, D::Error> {
        self.0.visit_some(StrictReader(value))
    }

    fn visit_newtype_struct<D: Deserializer<'de>>(self, value: D) -> Result<V::Value, D::Error> {
        self.0.visit_newtype_struct(StrictReader(value))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<V::Value, A::Error> {
        match self.1 {
            Shape::Any => self.0.visit_seq(StrictReader(values)),
            Shape::Table => Err(A::Error::invalid_type(Unexpected::Other("array"), &"a table")),
            Shape::Array(expected) => {
                let read = self.0.visit_seq(StrictReader(&mut values))?;
                let mut found = expected;
                while values.next_element::<IgnoredAny>()?.is_some() {
                    found += 1;
                }
                if found == expected {
                    Ok(read)
                } else {
                    Err(A::Error::invalid_length(found, &ArrayLength(expected)))
                }
            }
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, values: A) -> Result<V::Value, A::Error> {
        self.0.visit_map(StrictReader(values))
    }

    fn visit_enum<A: EnumAccess<'de>>(self, value: A) -> Result<V::Value, A::Error> {
        self.0.visit_enum(StrictReader(value))
    }
}

/// Expected length of an array, printed in serde's own wording.
struct ArrayLength(usize);

impl Expected for ArrayLength {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "an array of length {}", self.0)
    }
}

impl<'de, S: DeserializeSeed<'de>> DeserializeSeed<'de> for StrictReader<S> {
    type Value = S::Value;

    fn deserialize<D: Deserializer<'de>>(self, value: D) -> Result<S::Value, D::Error> {
        self.0.deserialize(StrictReader(value))
    }
}

impl<'de, A: SeqAccess<'de>> SeqAccess<'de> for StrictReader<A> {
    type Error = A::Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, A::Error> {
        self.0.next_element_seed(StrictReader(seed))
    }

    fn size_hint(&self) -> Option<usize> {
        self.0.size_hint()
    }
}

impl<'de, A: MapAccess<'de>> MapAccess<'de> for StrictReader<A> {
    type Error = A::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, A::Error> {
        self.0.next_key_seed(seed)
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, A::Error> {
        self.0.next_value_seed(StrictReader(seed))
    }

    fn size_hint(&self) -> Option<usize> {
        self.0.size_hint()
    }
}

impl<'de, A: EnumAccess<'de>> EnumAccess<'de> for StrictReader<A> {
    type Error = A::Error;
    type Variant = StrictReader<A::Variant>;

    fn variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<(T::Value, Self::Variant), A::Error> {
        self.0.variant_seed(seed).map(|(name, value)| (name, StrictReader(value)))
    }
}

impl<'de, A: VariantAccess<'de>> VariantAccess<'de> for StrictReader<A> {
    type Error = A::Error;

    fn unit_variant(self) -> Result<(), A::Error> {
        self.0.unit_variant()
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, A::Error> {
        self.0.newtype_variant_seed(StrictReader(seed))
    }

    fn tuple_variant<V: Visitor<'de>>(self, len: usize, visitor: V) -> Result<V::Value, A::Error> {
        self.0.tuple_variant(len, ShapeVisitor(visitor, Shape::Array(len)))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, A::Error> {
        self.0.struct_variant(fields, ShapeVisitor(visitor, Shape::Table))
    }
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::*;

    #[derive(Debug, PartialEq, Deserialize)]
    #[serde(deny_unknown_fields, rename_all = "snake_case")]
    struct Camera {
        radial: [f64; 3],
        corners: Option<Vec<[[f64; 2]; 2]>>,
        step: Option<Step>,
        law: Option<Law>,
        part: Option<Part>,
        pair: Option<(u8, u8)>,
    }

    #[derive(Debug, PartialEq, Deserialize)]
    #[serde(rename_all = "snake_case")]
    enum Step {
        None,
        Along([f64; 2]),
        Of { size: [f64; 2] },
        Both(f64, f64),
    }

    #[derive(Debug, PartialEq, Deserialize)]
    #[serde(tag = "kind", rename_all = "snake_case")]
    enum Law {
        Uniform { between: [f64; 2] },
    }

    #[derive(Debug, PartialEq, Deserialize)]
    struct Part {
        a: f64,
        b: f64,
    }

    fn read(text: &str) -> Result<Camera, toml::de::Error> {
        from_str(&format!("radial = [1, 2, 3]\n{text}"))
    }

    #[test]
    fn valid_values_are_read_as_by_toml() {
        for text in [
            "corners = [[[1, 2], [3, 4]], [[5, 6.5], [7, 8]]]\npair = [1, 2]",
            "step = 'none'",
            "step.along = [1, 2]",
            "step.of.size = [1, 2]",
            "step.both = [1, 2]",
            "law = { kind = 'uniform', between = [1, 2] }\npart = { a = 1, b = 2.0 }",
            "[part]\na = 1\nb = 2",
        ] {
            let text = format!("radial = [1, 2, 3]\n{text}");
            assert_eq!(from_str::<Camera>(&text).unwrap(), toml::from_str(&text).unwrap());
            assert_eq!(from_str::<toml::Table>(&text).unwrap(), toml::from_str(&text).unwrap());
        }
    }

    #[test]
    fn an_array_of_fixed_length_has_exactly_its_values() {
        for (text, length) in [
            ("corners = [[[1, 2, 3], [3, 4]]]", 3),
            ("corners = [[[1, 2], [3, 4], [5, 6], [7, 8]]]", 4),
            ("step.along = [1, 2, 3]", 3),
            ("step.of.size = [1, 2, 3]", 3),
            ("pair = [1, 2, 3]", 3),
            ("pair = [1]", 1),
        ] {
            let error = read(text).unwrap_err();
            assert!(
                error.message().contains(&format!("invalid length {length}, expected")),
                "{text}: {error}"
            );
            assert!(error.span().is_some_and(|span| span.start > 10), "{text}: {error}");
        }
        let error = from_str::<Camera>("radial = [1, 2, 3, 4, 5]").unwrap_err();
        assert_eq!(error.message(), "invalid length 5, expected an array of length 3");
        assert_eq!(error.span(), Some(9..24));
        for text in ["law = { kind = 'uniform', between = [1, 2, 3] }", "step.both = [1, 2, 3]"] {
            assert!(read(text).is_err(), "{text}");
        }
    }

    #[test]
    fn an_array_is_no_table() {
        for text in ["part = [1, 2]", "step.of = [[1, 2]]"] {
            let error = read(text).unwrap_err();
            assert_eq!(error.message(), "invalid type: array, expected a table", "{text}");
        }
    }
}
