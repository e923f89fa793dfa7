//! What other renderers were measured at, on the same scenes.

use std::path::Path;

use super::csv;
use crate::error::Error;

/// One measurement of a peer.
#[derive(Debug, Clone, PartialEq)]
pub struct Peer {
    /// Which renderer.
    pub peer: String,
    /// Name of the scene.
    pub scene: String,
    /// Name of the filter.
    pub filter: String,
    /// Name of the texture.
    pub texture: String,
    /// Threads that it ran on.
    pub threads: usize,
    /// Milliseconds of a frame, median.
    pub milliseconds: f64,
    /// RMSE against a box pixel, where it was taken.
    pub rmse: Option<f64>,
}

/// Columns that a peers' file must have; others are ignored.
const COLUMNS: [&str; 7] = [
    "peer",
    "scene",
    "filter",
    "texture",
    "threads",
    "ms_median",
    "rmse",
];

impl Peer {
    /// The measurements in a CSV file with at least the columns
    /// `peer,scene,filter,texture,threads,ms_median,rmse`. Rows of any scene are read.
    ///
    /// # Errors
    /// [`Error::Read`]; [`Error::Csv`], with line and column, for a missing column, a row of another length or what
    /// is not a number.
    pub fn load(path: &Path) -> Result<Vec<Self>, Error> {
        let text = std::fs::read_to_string(path).map_err(|source| Error::read(path, source))?;
        Self::parse(path, &text)
    }

    fn parse(path: &Path, text: &str) -> Result<Vec<Self>, Error> {
        let table = csv::Table::parse(path, text, &COLUMNS)?;
        table
            .rows()
            .map(|row| {
                Ok(Self {
                    peer: row.text("peer").to_owned(),
                    scene: row.text("scene").to_owned(),
                    filter: row.text("filter").to_owned(),
                    texture: row.text("texture").to_owned(),
                    threads: threads(row.number("threads")?),
                    milliseconds: row.number("ms_median")?,
                    rmse: row.number_if_any("rmse")?,
                })
            })
            .collect()
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates, and a count that is none matches no run of ours"
)]
fn threads(count: f64) -> usize {
    count as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_without_an_error_are_kept() {
        let text = "peer,scene,filter,texture,threads,ms_median,mpix_per_s,rmse,maxerr\n\
                    a,plane,aniso16,zone,2,20.5,70,0.0182,0.1\n\
                    a,fill_mag,bilinear,natural,1,6.6,300,,\n";
        let peers = Peer::parse(Path::new("p.csv"), text).unwrap();
        assert_eq!(peers.len(), 2);
        assert_eq!((peers[0].threads, peers[0].rmse), (2, Some(0.0182)));
        assert_eq!((peers[1].milliseconds, peers[1].rmse), (6.6, None));
    }

    #[test]
    fn a_broken_number_is_named() {
        let text =
            "peer,scene,filter,texture,threads,ms_median,rmse\na,plane,nearest,zone,2,fast,0.1\n";
        let said = Peer::parse(Path::new("p.csv"), text)
            .unwrap_err()
            .to_string();
        assert!(
            said.starts_with("p.csv:2:6: ms_median is \"fast\""),
            "{said}"
        );
    }
}
