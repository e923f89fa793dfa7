//! `texrender inspect`

use texrender::plan::scene_summary;
use texrender::{Error, Plan, load};

use crate::args::InspectArgs;
use crate::with_threads;

pub(crate) fn run(args: &InspectArgs) -> Result<(), Error> {
    with_threads(args.picture.threads.unwrap_or(0), || {
        let scene = load(&args.scene, &args.picture.load_options())?;
        let plan = Plan::new(&scene, &args.picture.settings(Vec::new()))?;
        println!("{} holds", args.scene.display());
        print!("{}", scene_summary(&scene));
        println!("a picture of it needs");
        print!("{}", plan.describe(&scene));
        Ok(())
    })
}
