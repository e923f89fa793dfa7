//! The Utah teapot: Martin Newell's 32 bicubic patches, from the published control points.
//!
//! Z is up; the spout points to +x, the handle to −x, the lid's knob ends at z = 3.15 and the bottom at
//! z = 0. Every patch has its front outside. On body, rim, lid and bottom v climbs along the profile and u
//! goes counter-clockwise seen from above, so a picture with s = u, t = 1 − v is not mirrored.
//!
//! The data are kept as they were designed: rings around the axis for the vessel, half cross-sections for
//! handle and spout; `patches` turns and mirrors them. The 28 patches of 1975 had no bottom; the last four
//! came later. The gap between lid and rim, the handle's ends inside the body and the open tip of the spout
//! belong to the model.
//!
//! # Source
//! Newell 1975, "The Utilization of Procedure Models in Digital Image Synthesis" (thesis, Utah); Crow 1987,
//! "The Origins of the Teapot", IEEE Computer Graphics and Applications 7(1), with the bottom.

use glam::Vec3;

use crate::surface::BezierPatch;

/// Four control points of a quarter turn: (radius, 0), (radius, shoulder), (shoulder, radius), (0, radius).
#[derive(Clone, Copy)]
struct Ring {
    radius: f64,
    shoulder: f64,
    height: f32,
}

/// A ring as almost all were published: shoulder = 0.56·radius.
const fn ring(radius: f64, height: f32) -> Ring {
    Ring {
        radius,
        shoulder: 0.56 * radius,
        height,
    }
}

/// The profiles of lid, rim, body and bottom, each four rings along the outside from the top down.
const PROFILES: [[Ring; 4]; 6] = [
    // Lid: the knob, then the cover.
    [
        ring(0.0, 3.15),
        // The one ring that was published with another shoulder.
        Ring {
            radius: 0.8,
            shoulder: 0.45,
            height: 3.15,
        },
        ring(0.0, 2.85),
        ring(0.2, 2.7),
    ],
    [
        ring(0.2, 2.7),
        ring(0.4, 2.55),
        ring(1.3, 2.55),
        ring(1.3, 2.4),
    ],
    // Rim: from the inside over the top.
    [
        ring(1.4, 2.4),
        ring(1.3375, 2.53125),
        ring(1.4375, 2.53125),
        ring(1.5, 2.4),
    ],
    // Body.
    [
        ring(1.5, 2.4),
        ring(1.75, 1.875),
        ring(2.0, 1.35),
        ring(2.0, 0.9),
    ],
    [
        ring(2.0, 0.9),
        ring(2.0, 0.45),
        ring(1.5, 0.225),
        ring(1.5, 0.15),
    ],
    // Bottom.
    [
        ring(1.5, 0.15),
        ring(1.5, 0.075),
        ring(1.425, 0.0),
        ring(0.0, 0.0),
    ],
];

/// Half a cross-section of handle or spout: from `start` in the plane y = 0, out to `half_width`, to `end`.
#[derive(Clone, Copy)]
struct Section {
    start: [f32; 2],
    end: [f32; 2],
    half_width: f32,
}

const fn section(start: [f32; 2], end: [f32; 2], half_width: f32) -> Section {
    Section {
        start,
        end,
        half_width,
    }
}

/// Sections along the handle from the rim down, (x, z) of both ends: two patches share the fourth.
const HANDLE: [Section; 7] = [
    section([-1.6, 2.025], [-1.5, 2.25], 0.3),
    section([-2.3, 2.025], [-2.5, 2.25], 0.3),
    section([-2.7, 2.025], [-3.0, 2.25], 0.3),
    section([-2.7, 1.8], [-3.0, 1.8], 0.3),
    section([-2.7, 1.575], [-3.0, 1.35], 0.3),
    section([-2.5, 1.125], [-2.65, 0.9375], 0.3),
    section([-2.0, 0.9], [-1.9, 0.6], 0.3),
];

/// Sections along the spout from the body to its tip, which turns inward.
const SPOUT: [Section; 7] = [
    section([1.7, 1.425], [1.7, 0.6], 0.66),
    section([2.6, 1.425], [3.1, 0.825], 0.66),
    section([2.3, 2.1], [2.4, 2.025], 0.25),
    section([2.7, 2.4], [3.3, 2.4], 0.25),
    section([2.8, 2.475], [3.525, 2.49375], 0.25),
    section([2.9, 2.475], [3.45, 2.5125], 0.15),
    section([2.8, 2.4], [3.2, 2.4], 0.15),
];

/// The 32 patches: 8 of the lid, 4 of the rim, 8 of the body, 4 of the bottom, 4 of the handle, 4 of the spout.
///
/// Within a part patches come ring by ring, each ring in the four quarters starting at −y, +x, +y, −x; handle
/// and spout by stretch, the −y side first.
///
/// # Examples
/// ```
/// let top = texcoord::teapot::patches()[0].at(glam::DVec2::ONE);
/// assert_eq!(top.position.as_vec3(), glam::Vec3::new(0.0, 0.0, 3.15));
/// ```
#[must_use]
pub fn patches() -> [BezierPatch; 32] {
    core::array::from_fn(|k| BezierPatch::bicubic(control_points(k)))
}

/// Rows along v of columns along u.
type Control = [[Vec3; 4]; 4];

fn control_points(k: usize) -> Control {
    match k {
        0..24 => turned_patch(&PROFILES[k / 4], k % 4),
        _ => {
            let limb = if k < 28 { &HANDLE } else { &SPOUT };
            let first = 3 * (k / 2 % 2);
            let half = half_tube([0, 1, 2, 3].map(|row| limb[first + row]));
            if k.is_multiple_of(2) {
                half
            } else {
                mirrored(half)
            }
        }
    }
}

/// A quarter of a surface of revolution; rows from the bottom of the profile up.
fn turned_patch(profile: &[Ring; 4], quarter: usize) -> Control {
    core::array::from_fn(|row| {
        let Ring {
            radius,
            shoulder,
            height,
        } = profile[3 - row];
        let arc = [
            [0.0, -radius],
            [shoulder, -radius],
            [radius, -shoulder],
            [radius, 0.0],
        ];
        arc.map(|point| {
            let [x, y] = turned(point, quarter).map(to_f32);
            Vec3::new(x, y, height)
        })
    })
}

/// `quarter` quarter turns counter-clockwise seen from above: exact, and without a −0 that would tell a
/// shared edge from its twin.
fn turned([x, y]: [f64; 2], quarter: usize) -> [f64; 2] {
    let [x, y] = match quarter {
        0 => [x, y],
        1 => [-y, x],
        2 => [-x, -y],
        _ => [y, -x],
    };
    [x + 0.0, y + 0.0]
}

/// The half of a tube on the −y side.
fn half_tube(sections: [Section; 4]) -> Control {
    sections.map(
        |Section {
             start: [x0, z0],
             end: [x1, z1],
             half_width,
         }| {
            [
                Vec3::new(x0, 0.0, z0),
                Vec3::new(x0, -half_width, z0),
                Vec3::new(x1, -half_width, z1),
                Vec3::new(x1, 0.0, z1),
            ]
        },
    )
}

/// The patch reflected in y = 0, read backwards along u so that its front stays outside.
fn mirrored(control: Control) -> Control {
    let reflected = |p: Vec3| Vec3::new(p.x, 0.0 - p.y, p.z);
    control.map(|[a, b, c, d]| [d, c, b, a].map(reflected))
}

/// Rounds a product of published decimals to the f32 nearest to it.
#[allow(
    clippy::cast_possible_truncation,
    reason = "the one rounding of the control points"
)]
fn to_f32(x: f64) -> f32 {
    x as f32
}
