//! `texrender frontier`

use texrender::Error;
use texrender::frontier::{Effort, Options, Peer, Scene, TestTexture, make_folder, measure};

use crate::args::FrontierArgs;
use crate::progress::Progress;
use crate::with_threads;

pub(crate) fn run(args: &FrontierArgs) -> Result<(), Error> {
    // What can be refused at once is refused before any work.
    let options = Options {
        scenes: match args.scene.as_str() {
            "all" if args.quick => Scene::quick(),
            "all" => Scene::all(),
            name => vec![Scene::named(name)?],
        },
        texture: args.texture.as_deref().map(TestTexture::load).transpose()?,
        effort: if args.quick {
            Effort::QUICK
        } else {
            Effort::FULL
        },
        peers: match &args.peers {
            Some(path) => Peer::load(path)?,
            None => Vec::new(),
        },
    };
    make_folder(&args.output)?;
    let frontier = with_threads(args.threads.unwrap_or(0), || {
        let progress = Progress::new();
        let frontier = measure(&options, &|stage, share| {
            progress.stage(stage.to_owned());
            progress.share(share);
        });
        progress.finish();
        frontier
    })?;
    frontier.save(&args.output, &command())
}

/// The command as it was given.
fn command() -> String {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    format!("texrender {}", arguments.join(" "))
}
