//! The cameras: composed in f64, rounded to f32, as the peers get them.

use glam::DMat3;

use super::picture::{HEIGHT, WIDTH};

/// A matrix, column by column; clip z in −w..=w.
pub(super) type Matrix = [[f64; 4]; 4];

/// No transform.
pub(super) const IDENTITY: Matrix = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
];

/// A perspective with its range of depth.
pub(super) fn perspective(fov_y_degrees: f64, near: f64, far: f64) -> Matrix {
    let scale = (0.5 * fov_y_degrees.to_radians()).tan().recip();
    let aspect = f64::from(WIDTH) / f64::from(HEIGHT);
    [
        [scale / aspect, 0.0, 0.0, 0.0],
        [0.0, scale, 0.0, 0.0],
        [0.0, 0.0, (far + near) / (near - far), -1.0],
        [0.0, 0.0, 2.0 * far * near / (near - far), 0.0],
    ]
}

/// Right, up and back, unit, of a view from `eye` to `target`, y up.
pub(super) fn axes(eye: [f64; 3], target: [f64; 3]) -> DMat3 {
    let forward = normalized([0, 1, 2].map(|k| target[k] - eye[k]));
    let side = normalized([-forward[2], 0.0, forward[0]]);
    let up = [
        side[1] * forward[2] - side[2] * forward[1],
        side[2] * forward[0] - side[0] * forward[2],
        side[0] * forward[1] - side[1] * forward[0],
    ];
    DMat3::from_cols_array_2d(&[side, up, forward.map(|x| -x)])
}

/// A view from `eye` to `target`, y up.
pub(super) fn look_at(eye: [f64; 3], target: [f64; 3]) -> Matrix {
    let [side, up, back] = axes(eye, target).to_cols_array_2d();
    let dot = |a: [f64; 3]| a[0] * eye[0] + a[1] * eye[1] + a[2] * eye[2];
    [
        [side[0], up[0], back[0], 0.0],
        [side[1], up[1], back[1], 0.0],
        [side[2], up[2], back[2], 0.0],
        [-dot(side), -dot(up), -dot(back), 1.0],
    ]
}

/// a·b.
pub(super) fn product(a: &Matrix, b: &Matrix) -> Matrix {
    b.map(|column| [0, 1, 2, 3].map(|i| (0..4).map(|k| a[k][i] * column[k]).sum()))
}

fn normalized(v: [f64; 3]) -> [f64; 3] {
    let length = v.map(|x| x * x).iter().sum::<f64>().sqrt();
    v.map(|x| x / length)
}
