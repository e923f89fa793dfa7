//! `texrender inspect`

use texrender::plan::scene_summary;
use texrender::{Error, Plan, load_document};

use crate::args::InspectArgs;
use crate::with_threads;

pub(crate) fn run(args: &InspectArgs) -> Result<(), Error> {
    with_threads(args.picture.threads.unwrap_or(0), || {
        let document = load_document(&args.scene, &args.picture.load_options())?;
        let settings = args.picture.settings(&document.settings, Vec::new());
        let scene = document.scene;
        let plan = Plan::new(&scene, &settings)?;
        println!("{} holds", args.scene.display());
        print!("{}", scene_summary(&scene));
        println!("a picture of it needs");
        print!("{}", plan.describe(&scene));
        Ok(())
    })
}
