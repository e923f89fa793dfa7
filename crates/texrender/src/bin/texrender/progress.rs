//! A progress bar on a terminal, nothing in a pipe.

use std::borrow::Cow;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Stages and the share of the frame that is rendered.
pub(crate) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar on standard error, if that is a terminal.
    pub(crate) fn new() -> Self {
        let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::stderr());
        // The template is a constant that parses.
        if let Ok(style) =
            ProgressStyle::with_template("{msg:10} {wide_bar} {percent:>3}% {elapsed}")
        {
            bar.set_style(style);
        }
        Self { bar }
    }

    pub(crate) fn stage(&self, name: impl Into<Cow<'static, str>>) {
        self.bar.set_message(name);
        self.bar.tick();
    }

    /// Share of the stage that is done, 0..=1.
    pub(crate) fn share(&self, share: f32) {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast saturates at 0"
        )]
        self.bar.set_position((share * STEPS as f32) as u64);
    }

    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
