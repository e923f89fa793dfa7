//! The table of results, to and from CSV.

use std::fmt::Write;
use std::path::Path;

use super::csv;
use crate::error::Error;

/// Columns of `frontier.csv`.
pub const COLUMNS: [&str; 10] = [
    "filter",
    "setting",
    "scene",
    "texture",
    "kernel",
    "ns_per_lookup",
    "ms_per_frame",
    "rmse",
    "max",
    "mean",
];

/// How far off a filter is, in 0..=1, over pixels and channels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Root of the mean square.
    pub rmse: f64,
    /// Greatest magnitude.
    pub max: f64,
    /// Mean of filter less reference: positive where the filter is too bright.
    pub mean: f64,
}

/// One row: one filter with one setting on one scene and texture, against one kernel.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Name of the filter.
    pub filter: String,
    /// Its setting.
    pub setting: String,
    /// Name of the scene.
    pub scene: String,
    /// Name of the texture.
    pub texture: String,
    /// `box`, `gaussian` or `own`.
    pub kernel: String,
    /// Nanoseconds of a lookup on one thread.
    pub ns_per_lookup: f64,
    /// Milliseconds of a frame.
    pub ms_per_frame: f64,
    /// Error against the kernel.
    pub errors: Errors,
}

/// The text of `frontier.csv`.
pub fn to_csv<'a>(rows: impl IntoIterator<Item = &'a Row>) -> String {
    let mut text = COLUMNS.join(",") + "\n";
    for row in rows {
        let Row {
            filter,
            setting,
            scene,
            texture,
            kernel,
            ..
        } = row;
        let Errors { rmse, max, mean } = row.errors;
        writeln!(
            text,
            "{filter},{setting},{scene},{texture},{kernel},{:.2},{:.3},{rmse:.6},{max:.6},{mean:.6}",
            row.ns_per_lookup, row.ms_per_frame,
        )
        .expect("writing to a string does not fail");
    }
    text
}

/// The rows in the text of a `frontier.csv`. `path` is for messages.
///
/// # Errors
/// [`Error::Csv`], with line and column, for a missing column, a row of another length or what is not a number.
pub fn from_csv(path: &Path, text: &str) -> Result<Vec<Row>, Error> {
    let table = csv::Table::parse(path, text, &COLUMNS)?;
    table
        .rows()
        .map(|row| {
            Ok(Row {
                filter: row.text("filter").to_owned(),
                setting: row.text("setting").to_owned(),
                scene: row.text("scene").to_owned(),
                texture: row.text("texture").to_owned(),
                kernel: row.text("kernel").to_owned(),
                ns_per_lookup: row.number("ns_per_lookup")?,
                ms_per_frame: row.number("ms_per_frame")?,
                errors: Errors {
                    rmse: row.number("rmse")?,
                    max: row.number("max")?,
                    mean: row.number("mean")?,
                },
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_survives_its_text() {
        let row = |filter: &str, mean| Row {
            filter: filter.to_owned(),
            setting: "exact".to_owned(),
            scene: "plane".to_owned(),
            texture: "zone".to_owned(),
            kernel: "box".to_owned(),
            ns_per_lookup: 12.25,
            ms_per_frame: 3.125,
            errors: Errors {
                rmse: 0.015625,
                max: 0.5,
                mean,
            },
        };
        let rows = vec![row("aniso16", -0.000977), row("nearest", 0.0)];
        let text = to_csv(&rows);
        assert!(text.starts_with(
            "filter,setting,scene,texture,kernel,ns_per_lookup,ms_per_frame,rmse,max,mean\n"
        ));
        assert_eq!(from_csv(Path::new("x.csv"), &text).unwrap(), rows);
    }
}
