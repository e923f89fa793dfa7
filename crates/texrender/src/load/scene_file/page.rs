//! The reference of the format, as a page.

use std::fmt::Write as _;

use super::key::{Kind, Value};
use super::kinds::{PATCH_FILE, SCENE};

/// Every table and key of scene files with its unit, range and default, in Markdown.
#[must_use]
pub fn reference_page() -> String {
    let mut kinds: Vec<&'static Kind> = Vec::new();
    collect(&SCENE, &mut kinds);
    collect(&PATCH_FILE, &mut kinds);
    let mut page = String::new();
    for kind in kinds {
        // Writing to a string does not fail.
        let _ = write_kind(&mut page, kind);
    }
    page
}

/// Lists a kind and those within it, each once.
fn collect(kind: &'static Kind, kinds: &mut Vec<&'static Kind>) {
    if kinds.iter().any(|listed| listed.name == kind.name) {
        return;
    }
    kinds.push(kind);
    for key in kind.keys {
        match key.value {
            Value::Table(kind)
            | Value::Named(kind)
            | Value::List(kind)
            | Value::TextureUse(kind) => collect(kind, kinds),
            _ => {}
        }
    }
}

fn write_kind(page: &mut String, kind: &Kind) -> std::fmt::Result {
    writeln!(page, "## {}\n\n{}\n", kind.name, kind.about)?;
    let has_variants = kind.keys.iter().any(|key| !key.of.is_empty());
    let tag = kind.tag.filter(|_| has_variants);
    match tag {
        Some(tag) => writeln!(
            page,
            "| key | for `{tag}` | value | left out | meaning |\n|---|---|---|---|---|"
        )?,
        None => writeln!(
            page,
            "| key | value | left out | meaning |\n|---|---|---|---|"
        )?,
    }
    for key in kind.keys {
        let of = match (tag, key.of) {
            (None, _) => String::new(),
            (Some(_), []) => " all |".to_owned(),
            (Some(_), of) => format!(" {} |", of.join(", ")),
        };
        writeln!(
            page,
            "| `{}` |{of} {} | {} | {} |",
            key.name,
            key.value.describe(),
            key.default.describe(),
            key.about
        )?;
    }
    writeln!(page)
}
