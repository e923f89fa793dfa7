//! Which plots a sheet gets, and how it compares with peers.

use super::family::Family;
use super::measure::{KERNELS, Sheet};
use super::peers::Peer;
use super::plot::{Front, Plot, Point, pareto_front};
use super::table::Row;

/// A plot with the name of its file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Chart {
    /// Without folder and extension.
    pub(super) name: String,
    pub(super) plot: Plot,
}

/// One of our filters beside the same of a peer.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rival<'a> {
    pub(super) ours: &'a Row,
    pub(super) peer: &'a Peer,
}

impl Sheet {
    /// What it is called in titles.
    pub(super) fn title(&self) -> String {
        format!("{} · {}", self.scene.name, self.texture)
    }

    /// As part of file names and anchors.
    pub(super) fn stem(&self) -> String {
        format!("{}-{}", self.scene.name, self.texture)
    }

    /// The rows against `kernel`, filter by filter.
    pub(super) fn rows_against(&self, kernel: &str) -> Vec<&Row> {
        self.rows
            .iter()
            .filter(|row| row.kernel == kernel)
            .collect()
    }

    /// Which of [`Sheet::rows_against`] are on the Pareto front of time a lookup; none against the own kernels, which
    /// differ.
    pub(super) fn front(&self, kernel: &str) -> Vec<usize> {
        if kernel == "own" {
            return Vec::new();
        }
        let rows = self.rows_against(kernel);
        let points: Vec<(f64, f64)> = rows
            .iter()
            .map(|row| (row.ns_per_lookup, row.errors.rmse))
            .collect();
        pareto_front(&points)
    }

    /// A plot for each kernel, the box first.
    pub(super) fn charts(&self) -> Vec<Chart> {
        KERNELS
            .into_iter()
            .map(|kernel| self.chart(kernel))
            .collect()
    }

    fn chart(&self, kernel: &'static str) -> Chart {
        let against = match kernel {
            "box" => "a box pixel",
            "gaussian" => "a Gaussian pixel",
            _ => "each filter’s own kernel",
        };
        let points = self.rows_against(kernel).into_iter().map(|row| Point {
            label: label(&row.filter, &row.setting),
            family: Family::of(&row.filter),
            time: row.ns_per_lookup,
            error: row.errors.rmse,
        });
        Chart {
            name: format!("{}-{kernel}", self.stem()),
            plot: Plot {
                title: format!("{}, against {against}", self.title()),
                time_label: "nanoseconds a lookup, one thread".to_owned(),
                error_label: "RMSE".to_owned(),
                front: if kernel == "own" {
                    Front::LeftOut
                } else {
                    Front::Drawn
                },
                points: points.collect(),
            },
        }
    }

    /// Time a frame against error beside peers on as many threads; `None` if there is no such peer.
    pub(super) fn peers_chart(&self, peers: &[Peer], threads: usize) -> Option<Chart> {
        let names = peer_names(peers);
        let rivals = peers
            .iter()
            .filter(|peer| self.is_rival(peer, threads) && peer.milliseconds > 0.0);
        let theirs: Vec<Point> = rivals
            .filter_map(|peer| {
                Some(Point {
                    label: peer.filter.clone(),
                    family: Family::Peer(names.iter().position(|name| *name == peer.peer)?),
                    time: peer.milliseconds,
                    error: peer.rmse?,
                })
            })
            .collect();
        if theirs.is_empty() {
            return None;
        }
        let ours = self.rows_against(KERNELS[0]).into_iter().map(|row| Point {
            label: label(&row.filter, &row.setting),
            family: Family::of(&row.filter),
            time: row.ms_per_frame,
            error: row.errors.rmse,
        });
        Some(Chart {
            name: format!("{}-peers", self.stem()),
            plot: Plot {
                title: format!(
                    "{}, a frame on {threads} threads beside peers, against a box pixel",
                    self.title()
                ),
                time_label: "milliseconds a frame".to_owned(),
                error_label: "RMSE".to_owned(),
                front: Front::Drawn,
                points: ours.chain(theirs).collect(),
            },
        })
    }

    /// Our filters beside peers' of the same name on as many threads, filter by filter.
    pub(super) fn rivals<'a>(&'a self, peers: &'a [Peer], threads: usize) -> Vec<Rival<'a>> {
        self.rows_against(KERNELS[0])
            .into_iter()
            .flat_map(|ours| {
                peers
                    .iter()
                    .filter(move |peer| self.is_rival(peer, threads) && peer.filter == ours.filter)
                    .map(move |peer| Rival { ours, peer })
            })
            .collect()
    }

    fn is_rival(&self, peer: &Peer, threads: usize) -> bool {
        peer.scene == self.scene.name && peer.texture == self.texture && peer.threads == threads
    }
}

/// Names of peers, in the order of their first row.
pub(super) fn peer_names(peers: &[Peer]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for peer in peers {
        if !names.contains(&peer.peer.as_str()) {
            names.push(&peer.peer);
        }
    }
    names
}

/// A filter's name, with its setting unless that is the plain one.
pub(super) fn label(filter: &str, setting: &str) -> String {
    if setting == "exact" {
        filter.to_owned()
    } else {
        format!("{filter} {setting}")
    }
}
