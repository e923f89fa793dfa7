//! The format as JSON Schema, for editors.

use serde_json::{Map, Value as Json, json};

use super::key::{Default, Key, Kind, Value};
use super::kinds::SCENE;

/// The JSON Schema (draft 2020-12) of scene files, as text. Editors that check TOML by it know every key, unit, range
/// and default.
#[must_use]
pub fn json_schema() -> String {
    let mut schema = table(&SCENE);
    if let Json::Object(members) = &mut schema {
        members.insert(
            "$schema".to_owned(),
            json!("https://json-schema.org/draft/2020-12/schema"),
        );
        members.insert("title".to_owned(), json!("texrender scene file"));
    }
    format!("{schema:#}")
}

/// One schema for each value of the tag, or one for all.
fn table(kind: &'static Kind) -> Json {
    let words = kind.tag.and_then(|tag| {
        let key = kind.keys.iter().find(|key| key.name == tag)?;
        match &key.value {
            Value::Choice(words) => Some((key, *words)),
            _ => None,
        }
    });
    let Some((tag, words)) = words else {
        return object(kind, None);
    };
    let variants: Vec<Json> = words
        .iter()
        .map(|word| object(kind, Some((tag, word))))
        .collect();
    json!({ "description": kind.about, "anyOf": variants })
}

fn object(kind: &'static Kind, variant: Option<(&Key, &'static str)>) -> Json {
    let (mut members, mut required) = (Map::new(), Vec::new());
    for key in kind.keys_of(variant.map(|(_, word)| word)) {
        let mut schema = value(&key.value);
        if let Some((_, word)) = variant.filter(|(tag, _)| tag.name == key.name) {
            schema = json!({ "const": word });
        }
        if let Json::Object(schema) = &mut schema {
            schema.insert("description".to_owned(), json!(about(key)));
            if let Some(default) = default(&key.default) {
                schema.insert("default".to_owned(), default);
            }
        }
        let is_default = |word: &str| matches!(key.default, Default::Text(text) if text == word);
        let names_variant =
            variant.is_some_and(|(tag, word)| tag.name == key.name && !is_default(word));
        if matches!(key.default, Default::Required) || names_variant {
            required.push(key.name);
        }
        members.insert(key.name.to_owned(), schema);
    }
    json!({
        "type": "object",
        "description": kind.about,
        "properties": members,
        "required": required,
        "additionalProperties": false,
    })
}

/// What a key means, with its unit and what holds without it.
fn about(key: &Key) -> String {
    let left_out = match &key.default {
        Default::Is(what) => format!(" Left out: {what}."),
        _ => String::new(),
    };
    format!("{} ({}){left_out}", key.about, key.value.describe())
}

fn default(default: &Default) -> Option<Json> {
    match default {
        Default::Required | Default::Is(_) => None,
        Default::Number(number) => Some(json!(number)),
        Default::Count(number) => Some(json!(number)),
        Default::Flag(flag) => Some(json!(flag)),
        Default::Text(text) => Some(json!(text)),
        Default::Numbers(numbers) => Some(json!(numbers)),
    }
}

fn value(value: &'static Value) -> Json {
    let list = |count: usize| json!({ "type": "array", "items": { "type": "number" }, "minItems": count, "maxItems": count });
    let color = || {
        json!({ "anyOf": [
            { "type": "string", "pattern": "^#([0-9a-fA-F]{3}|[0-9a-fA-F]{6})$" },
            { "type": "array", "items": { "type": "number", "minimum": 0 }, "minItems": 3, "maxItems": 3 },
        ] })
    };
    match value {
        Value::Flag => json!({ "type": "boolean" }),
        Value::Number { least, most, .. } => {
            let mut schema = json!({ "type": "number" });
            for (name, bound) in [("minimum", least), ("maximum", most)] {
                if bound.is_finite() {
                    schema[name] = json!(bound);
                }
            }
            schema
        }
        Value::Positive { .. } => json!({ "type": "number", "exclusiveMinimum": 0 }),
        Value::Count { least, most } => {
            json!({ "type": "integer", "minimum": least, "maximum": most })
        }
        Value::Text | Value::Reference(_) | Value::File => json!({ "type": "string" }),
        Value::Choice(words) => json!({ "enum": words }),
        Value::Numbers { count, .. } => list(*count),
        Value::Scale => json!({ "anyOf": [{ "type": "number" }, list(3)] }),
        Value::Color => color(),
        Value::Colors => {
            json!({ "type": "array", "items": color(), "minItems": 2, "maxItems": 2 })
        }
        Value::Matrix => {
            json!({ "type": "array", "items": list(4), "minItems": 3, "maxItems": 4 })
        }
        Value::Points => json!({ "type": "array", "items": list(3) }),
        Value::NumberList => json!({ "type": "array", "items": { "type": "number" } }),
        Value::Files => json!({ "type": "array", "items": { "type": "string" } }),
        Value::TextureUse(kind) => json!({ "anyOf": [{ "type": "string" }, table(kind)] }),
        Value::Table(kind) => table(kind),
        Value::Named(kind) => json!({ "type": "object", "additionalProperties": table(kind) }),
        Value::List(kind) => json!({ "type": "array", "items": table(kind) }),
    }
}
