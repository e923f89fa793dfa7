//! `texrender schema`

use std::io::Write;
use std::path::PathBuf;

use texrender::Error;
use texrender::load::{json_schema, reference_page};

use crate::args::SchemaArgs;

pub(crate) fn run(args: &SchemaArgs) -> Result<(), Error> {
    let text = if args.markdown {
        reference_page()
    } else {
        json_schema() + "\n"
    };
    let written = std::io::stdout().write_all(text.as_bytes());
    written.map_err(|error| Error::Write {
        path: PathBuf::from("standard output"),
        detail: error.to_string(),
    })
}
