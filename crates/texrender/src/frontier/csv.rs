//! Tables of plain comma-separated values: no quotes, no commas within a field.

use std::path::{Path, PathBuf};

use crate::error::Error;

/// A table with named columns. Columns that nobody asked for are kept and ignored.
#[derive(Debug)]
pub(super) struct Table<'a> {
    path: PathBuf,
    header: Vec<&'a str>,
    /// Line numbers from 1, and fields.
    lines: Vec<(usize, Vec<&'a str>)>,
}

/// One row of a table.
#[derive(Debug, Clone, Copy)]
pub(super) struct TableRow<'a> {
    table: &'a Table<'a>,
    line: usize,
    fields: &'a [&'a str],
}

impl<'a> Table<'a> {
    /// The table in `text`, which must have all `columns`, in any order. Empty lines are skipped.
    pub(super) fn parse(path: &Path, text: &'a str, columns: &[&str]) -> Result<Self, Error> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut lines = (1..)
            .zip(text.lines())
            .filter(|(_, line)| !line.trim().is_empty())
            .map(|(number, line)| (number, line.split(',').map(str::trim).collect::<Vec<_>>()));
        let error = |line, column, detail| Error::Csv {
            path: path.to_owned(),
            line,
            column,
            detail,
        };
        let (first, header) = lines.next().ok_or_else(|| {
            error(
                1,
                1,
                "the file is empty; its first line names columns".to_owned(),
            )
        })?;
        for column in columns {
            if !header.contains(column) {
                return Err(error(
                    first,
                    1,
                    format!(
                        "there is no column {column}; the first line names {}",
                        header.join(",")
                    ),
                ));
            }
        }
        let lines: Vec<(usize, Vec<&str>)> = lines.collect();
        for (line, fields) in &lines {
            if fields.len() != header.len() {
                return Err(error(
                    *line,
                    fields.len().min(header.len() + 1),
                    format!(
                        "{} fields where the first line names {}",
                        fields.len(),
                        header.len()
                    ),
                ));
            }
        }
        Ok(Self {
            path: path.to_owned(),
            header,
            lines,
        })
    }

    pub(super) fn rows(&'a self) -> impl Iterator<Item = TableRow<'a>> {
        self.lines.iter().map(|(line, fields)| TableRow {
            table: self,
            line: *line,
            fields,
        })
    }

    fn column(&self, name: &str) -> usize {
        self.header
            .iter()
            .position(|column| *column == name)
            .expect("columns asked for were checked when the table was read")
    }
}

impl<'a> TableRow<'a> {
    /// The field of a column that [`Table::parse`] was told of.
    pub(super) fn text(&self, column: &str) -> &'a str {
        self.fields[self.table.column(column)]
    }

    /// A finite number in that column.
    pub(super) fn number(&self, column: &str) -> Result<f64, Error> {
        let field = self.text(column);
        field
            .parse()
            .ok()
            .filter(|x: &f64| x.is_finite())
            .ok_or_else(|| Error::Csv {
                path: self.table.path.clone(),
                line: self.line,
                column: self.table.column(column) + 1,
                detail: format!("{column} is {field:?}, which is not a finite number"),
            })
    }

    /// As [`TableRow::number`]; `None` for an empty field.
    pub(super) fn number_if_any(&self, column: &str) -> Result<Option<f64>, Error> {
        if self.text(column).is_empty() {
            Ok(None)
        } else {
            self.number(column).map(Some)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(text: &str) -> String {
        let path = Path::new("t.csv");
        let done = Table::parse(path, text, &["a", "b"]).and_then(|table| {
            table
                .rows()
                .map(|row| row.number("b"))
                .collect::<Result<Vec<_>, _>>()
        });
        done.unwrap_err().to_string()
    }

    #[test]
    fn errors_name_line_and_column() {
        assert!(said("").starts_with("t.csv:1:1: "));
        assert!(said("a,c\n1,2\n").contains("no column b"));
        assert!(said("a,b\n1,2\n\n1,x\n").starts_with("t.csv:4:2: b is \"x\""));
        assert!(said("a,b\n1,2\n1,2,3\n").starts_with("t.csv:3:3: 3 fields"));
        assert!(said("a,b\n1\n").starts_with("t.csv:2:1: 1 fields"));
        assert!(said("a,b\n1,inf\n").contains("not a finite number"));
    }

    #[test]
    fn columns_may_stand_in_any_order() {
        let table = Table::parse(
            Path::new("t.csv"),
            "b,z,a\r\n1,2,3\r\n,5,6\r\n",
            &["a", "b"],
        )
        .unwrap();
        let rows: Vec<_> = table.rows().collect();
        assert_eq!(rows[0].text("a"), "3");
        assert_eq!(rows[0].number_if_any("b").unwrap(), Some(1.0));
        assert_eq!(rows[1].number_if_any("b").unwrap(), None);
    }
}
