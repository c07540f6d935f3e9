//! From the document tree to a struct by serde, keeping the path and the kind of whatever does not fit.
//!
//! The `toml` crate's own deserializer reports text; suggestions need the flaw itself: which keys were known, which type.

use std::fmt;

use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error as _, Expected, IntoDeserializer, MapAccess,
    SeqAccess, Unexpected, VariantAccess, Visitor, value::StrDeserializer,
};
use serde::forward_to_deserialize_any;

use super::document::{Node, Path, Value};
use super::words::{expected_in_words, found_in_words};

/// Something in the document that does not fit the struct.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Flaw {
    /// Steps from the flaw to the root.
    reversed_path: Path,
    /// What does not fit there.
    pub kind: FlawKind,
}

/// What does not fit.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum FlawKind {
    /// A key that the table does not have.
    UnknownKey { key: String, known: &'static [&'static str] },
    /// A kind that does not exist.
    UnknownVariant { found: String, known: &'static [&'static str] },
    /// A table that must name exactly one kind names none or several.
    VariantCount { found: Vec<String>, known: &'static [&'static str] },
    /// A key that must be there.
    MissingKey { key: &'static str },
    /// A value of another type.
    WrongType { found: String, expected: String },
    /// A list of another length.
    WrongLength { found: usize, expected: String },
    /// Anything else, in words.
    Other(String),
}

/// Decodes a document.
pub(crate) fn decode<T: DeserializeOwned>(root: &Node) -> Result<T, Flaw> {
    T::deserialize(At(root))
}

impl Flaw {
    fn new(kind: FlawKind) -> Self {
        Self { reversed_path: Vec::new(), kind }
    }

    /// The same flaw, seen from the table or list that has its place under `step`.
    pub fn inside(mut self, step: &str) -> Self {
        self.reversed_path.push(step.to_owned());
        self
    }

    /// Path of the table, list or value at fault.
    pub fn path(&self) -> Path {
        self.reversed_path.iter().rev().cloned().collect()
    }
}

impl fmt::Display for Flaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {:?}", self.path().join("."), self.kind)
    }
}

impl std::error::Error for Flaw {}

impl serde::de::Error for Flaw {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self::new(FlawKind::Other(message.to_string()))
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::new(FlawKind::WrongType { found: found_in_words(found), expected: expected_in_words(expected) })
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::invalid_type(found, expected)
    }

    fn invalid_length(found: usize, expected: &dyn Expected) -> Self {
        Self::new(FlawKind::WrongLength { found, expected: expected_in_words(expected) })
    }

    fn unknown_variant(found: &str, known: &'static [&'static str]) -> Self {
        Self::new(FlawKind::UnknownVariant { found: found.to_owned(), known })
    }

    fn unknown_field(key: &str, known: &'static [&'static str]) -> Self {
        Self::new(FlawKind::UnknownKey { key: key.to_owned(), known })
    }

    fn missing_field(key: &'static str) -> Self {
        Self::new(FlawKind::MissingKey { key })
    }
}

/// A node that is being decoded.
#[derive(Clone, Copy)]
struct At<'a>(&'a Node);

impl<'a> At<'a> {
    fn unexpected(self) -> Unexpected<'a> {
        match &self.0.value {
            Value::Text(text) => Unexpected::Str(text),
            Value::Integer(number) => {
                i64::try_from(*number).map_or(Unexpected::Other("a very large number"), Unexpected::Signed)
            }
            Value::Float(number) => Unexpected::Float(*number),
            Value::Boolean(truth) => Unexpected::Bool(*truth),
            Value::Date => Unexpected::Other("a date or time"),
            Value::List(_) => Unexpected::Seq,
            Value::Table(_) => Unexpected::Map,
        }
    }
}

impl<'de> Deserializer<'de> for At<'_> {
    type Error = Flaw;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Flaw> {
        match &self.0.value {
            Value::Text(text) => visitor.visit_str(text),
            Value::Integer(number) => match (i64::try_from(*number), u64::try_from(*number)) {
                (Ok(number), _) => visitor.visit_i64(number),
                (_, Ok(number)) => visitor.visit_u64(number),
                _ => Err(Flaw::invalid_type(self.unexpected(), &visitor)),
            },
            Value::Float(number) => visitor.visit_f64(*number),
            Value::Boolean(truth) => visitor.visit_bool(*truth),
            Value::Date => Err(Flaw::invalid_type(self.unexpected(), &visitor)),
            Value::List(entries) => visit_list(entries, visitor),
            Value::Table(entries) => visitor.visit_map(Entries { entries: entries.iter(), value: None }),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Flaw> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Flaw> {
        visitor.visit_newtype_struct(self)
    }

    /// A struct is a table: serde would also take a list, whose entries name no keys.
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Flaw> {
        match &self.0.value {
            Value::Table(_) => self.deserialize_any(visitor),
            _ => Err(Flaw::invalid_type(self.unexpected(), &"a table")),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        known: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Flaw> {
        match &self.0.value {
            Value::Text(name) => visitor.visit_enum(Kind { name, content: None }),
            Value::Table(entries) => match entries.iter().next() {
                Some((name, content)) if entries.len() == 1 => {
                    visitor.visit_enum(Kind { name, content: Some(content) })
                }
                _ => Err(Flaw::new(FlawKind::VariantCount { found: entries.keys().cloned().collect(), known })),
            },
            _ => Err(Flaw::invalid_type(self.unexpected(), &"a text or a table")),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map identifier ignored_any
    }
}

fn visit_list<'de, V: Visitor<'de>>(entries: &[Node], visitor: V) -> Result<V::Value, Flaw> {
    let mut rest = List { entries, next: 0 };
    let value = visitor.visit_seq(&mut rest)?;
    if rest.next == entries.len() {
        return Ok(value);
    }
    let expected = format!("a list of {} values", rest.next);
    Err(Flaw::new(FlawKind::WrongLength { found: entries.len(), expected }))
}

struct List<'a> {
    entries: &'a [Node],
    next: usize,
}

impl<'de> SeqAccess<'de> for &mut List<'_> {
    type Error = Flaw;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Flaw> {
        let Some(node) = self.entries.get(self.next) else { return Ok(None) };
        let index = self.next.to_string();
        self.next += 1;
        seed.deserialize(At(node)).map(Some).map_err(|flaw| flaw.inside(&index))
    }
}

struct Entries<'a> {
    entries: std::collections::btree_map::Iter<'a, String, Node>,
    value: Option<(&'a str, &'a Node)>,
}

impl<'de> MapAccess<'de> for Entries<'_> {
    type Error = Flaw;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Flaw> {
        let Some((key, node)) = self.entries.next() else { return Ok(None) };
        self.value = Some((key, node));
        let key: StrDeserializer<'_, Flaw> = key.as_str().into_deserializer();
        seed.deserialize(key).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Flaw> {
        let Some((key, node)) = self.value.take() else { return Err(Flaw::custom("a value was read before its key")) };
        seed.deserialize(At(node)).map_err(|flaw| flaw.inside(key))
    }
}

/// A kind: a bare name, or a name with a table of options. A bare name stands for an empty table.
struct Kind<'a> {
    name: &'a str,
    content: Option<&'a Node>,
}

impl<'de, 'a> EnumAccess<'de> for Kind<'a> {
    type Error = Flaw;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Flaw> {
        let name: StrDeserializer<'_, Flaw> = self.name.into_deserializer();
        Ok((seed.deserialize(name)?, self))
    }
}

impl Kind<'_> {
    fn with<T>(&self, read: impl FnOnce(At<'_>) -> Result<T, Flaw>) -> Result<T, Flaw> {
        let empty = Node { key: 0..0, span: 0..0, value: Value::Table(Default::default()) };
        read(At(self.content.unwrap_or(&empty))).map_err(|flaw| flaw.inside(self.name))
    }
}

impl<'de> VariantAccess<'de> for Kind<'_> {
    type Error = Flaw;

    fn unit_variant(self) -> Result<(), Flaw> {
        match self.content.map(|node| (&node.value, At(node).unexpected())) {
            None => Ok(()),
            Some((Value::Table(entries), _)) if entries.is_empty() => Ok(()),
            Some((_, found)) => Err(Flaw::invalid_type(found, &"an empty table: it has no options").inside(self.name)),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Flaw> {
        self.with(|node| seed.deserialize(node))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Flaw> {
        self.with(|node| node.deserialize_any(visitor))
    }

    fn struct_variant<V: Visitor<'de>>(self, fields: &'static [&'static str], visitor: V) -> Result<V::Value, Flaw> {
        self.with(|node| node.deserialize_struct("", fields, visitor))
    }
}
