//! Values of a scene file: whether they are what they should be, and as numbers, colours and words.

use glam::{DVec3, Vec3};
use sampler::transfer::srgb_to_linear;
use toml::Spanned;
use toml::de::DeValue;

use super::key::Value;
use crate::text::hex_color;

/// Whether a value is what it should be; else what that is.
pub(super) fn check(expected: &Value, value: &DeValue<'_>) -> Result<(), String> {
    let ok = match expected {
        Value::Flag => value.as_bool().is_some(),
        Value::Number { least, most, .. } => {
            number(value).is_some_and(|n| n >= *least && n <= *most)
        }
        Value::Positive { .. } => number(value).is_some_and(|n| n > 0.0),
        Value::Count { least, most } => integer(value).is_some_and(|n| n >= *least && n <= *most),
        Value::Text | Value::Reference(_) | Value::File => value.as_str().is_some(),
        Value::Choice(words) => {
            let text = value.as_str();
            if let Some(text) = text.filter(|text| !words.contains(text)) {
                let near = nearest(text, words.iter().copied());
                let hint = near.map_or(String::new(), |near| format!(" (did you mean '{near}'?)"));
                return Err(format!("one of {}{hint}", words.join(", ")));
            }
            text.is_some()
        }
        Value::Numbers { count, .. } => numbers(value).is_some_and(|n| n.len() == *count),
        Value::Scale => number(value).is_some() || numbers(value).is_some_and(|n| n.len() == 3),
        Value::Color => color(value).is_some(),
        Value::Colors => value.as_array().is_some_and(|list| {
            list.len() == 2 && list.iter().all(|c| color(c.get_ref()).is_some())
        }),
        Value::Matrix => value.as_array().is_some_and(|rows| {
            let four = |row: &Spanned<DeValue<'_>>| {
                numbers(row.get_ref()).is_some_and(|numbers| numbers.len() == 4)
            };
            (3..=4).contains(&rows.len()) && rows.iter().all(four)
        }),
        Value::Points => value.as_array().is_some_and(|rows| {
            let three = |row: &Spanned<DeValue<'_>>| {
                numbers(row.get_ref()).is_some_and(|numbers| numbers.len() == 3)
            };
            rows.iter().all(three)
        }),
        Value::NumberList => numbers(value).is_some(),
        Value::Files => value
            .as_array()
            .is_some_and(|list| list.iter().all(|text| text.get_ref().as_str().is_some())),
        Value::TextureUse(_) => value.as_str().is_some() || value.as_table().is_some(),
        Value::Table(_) => value.as_table().is_some(),
        Value::Named(_) => value.as_table().is_some_and(|tables| {
            tables
                .values()
                .all(|table| table.get_ref().as_table().is_some())
        }),
        Value::List(_) => value.as_array().is_some_and(|list| {
            list.iter()
                .all(|table| table.get_ref().as_table().is_some())
        }),
    };
    if ok { Ok(()) } else { Err(expected.describe()) }
}

/// What a value is, for messages.
pub(super) fn found(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("'{text}'"),
        DeValue::Integer(number) => number.as_str().to_owned(),
        DeValue::Float(number) => number.as_str().to_owned(),
        DeValue::Boolean(flag) => flag.to_string(),
        DeValue::Datetime(_) => "a date".to_owned(),
        DeValue::Array(list) => format!("a list of {}", list.len()),
        DeValue::Table(_) => "a table".to_owned(),
    }
}

pub(super) fn integer(value: &DeValue<'_>) -> Option<i64> {
    let integer = value.as_integer()?;
    i64::from_str_radix(integer.as_str(), integer.radix()).ok()
}

/// A finite number, whole or not.
pub(super) fn number(value: &DeValue<'_>) -> Option<f64> {
    let number = match value {
        DeValue::Integer(_) => integer(value)? as f64,
        DeValue::Float(number) => number.as_str().parse().ok()?,
        _ => return None,
    };
    number.is_finite().then_some(number)
}

pub(super) fn numbers(value: &DeValue<'_>) -> Option<Vec<f64>> {
    let list = value.as_array()?.iter();
    list.map(|value| number(value.get_ref())).collect()
}

pub(super) fn color(value: &DeValue<'_>) -> Option<Vec3> {
    if let Some(text) = value.as_str() {
        let linear = |code: u8| srgb_to_linear(f32::from(code) / 255.0);
        return hex_color(text).map(|codes| Vec3::from(codes.map(linear)));
    }
    match *numbers(value)? {
        [r, g, b] if r.min(g).min(b) >= 0.0 => Some(DVec3::new(r, g, b).as_vec3()),
        _ => None,
    }
}

/// The word of a list that is most like one that is not in it, if any is alike.
pub(super) fn nearest<'a>(word: &str, words: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let distance = |other: &str| strsim::osa_distance(word, other);
    let best = words.min_by_key(|other| distance(other))?;
    let most = word.chars().count().max(best.chars().count()).div_ceil(2);
    (distance(best) <= most.max(1)).then_some(best)
}
