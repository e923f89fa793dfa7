//! A frontier as files.

use std::path::{Path, PathBuf};

use super::{Frontier, page, to_csv};
use crate::error::Error;
use crate::finish::replace;

/// Folders of the plots and of the crops, in the folder of the report.
const FOLDERS: [&str; 2] = ["plots", "crops"];

/// Makes the folder of a report, and those in it, and checks that files can be written there.
///
/// # Errors
/// [`Error::Write`].
pub fn make_folder(folder: &Path) -> Result<(), Error> {
    let error = |path: &Path, detail: String| Error::Write {
        path: path.to_owned(),
        detail,
    };
    if folder.exists() && !folder.is_dir() {
        return Err(error(folder, "it is a file; name a folder".to_owned()));
    }
    for path in FOLDERS.map(|name| folder.join(name)) {
        std::fs::create_dir_all(&path).map_err(|e| error(&path, e.to_string()))?;
    }
    tempfile::tempfile_in(folder).map_err(|e| error(folder, e.to_string()))?;
    Ok(())
}

impl Frontier {
    /// Writes `frontier.csv`, `plots/*.svg`, `crops/*.png` and `index.html` into `folder`, which is made if it is not
    /// there. Each file appears whole or not at all; the page, which holds all the rest, comes last.
    ///
    /// `command`: what the page says that it was made by.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn save(&self, folder: &Path, command: &str) -> Result<(), Error> {
        make_folder(folder)?;
        let rows = self.sheets.iter().flat_map(|sheet| &sheet.rows);
        replace(&folder.join("frontier.csv"), to_csv(rows).as_bytes())?;
        let [plots, crops] = FOLDERS.map(|name| folder.join(name));
        let file = |folder: &PathBuf, name: String| folder.join(name);
        for sheet in &self.sheets {
            let charts = sheet.charts().into_iter();
            for chart in charts.chain(sheet.peers_chart(&self.peers, self.threads)) {
                let path = file(&plots, format!("{}.svg", chart.name));
                replace(&path, chart.plot.to_svg().as_bytes())?;
            }
            for set in &sheet.crops {
                let path = file(&crops, format!("{}-{}.png", sheet.stem(), set.crop.name));
                replace(&path, &set.side_by_side().to_png())?;
            }
        }
        replace(
            &folder.join("index.html"),
            page::html(self, command).as_bytes(),
        )
    }
}
