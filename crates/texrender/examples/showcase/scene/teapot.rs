//! The Utah teapot from its patches, as a vessel (body, rim, lid, bottom) and its limbs.

use glam::{Vec2, Vec3};
use texrender::texcoord::surface::SurfaceMesh;
use texrender::texcoord::teapot;

use super::ceramic::{HEIGHT, RINGS};
use super::mesh::Mesh;

/// Steps along the side of a patch.
const STEPS: u32 = 12;

/// Body, rim, lid and bottom; s goes round twice a turn, t runs down the whole profile.
pub(super) fn vessel(scale: f32) -> Mesh {
    let mut mesh = Mesh::default();
    for (k, patch) in (0u8..24).zip(teapot::patches()) {
        let (ring, quarter) = (usize::from(5 - k / 4), f32::from(k % 4));
        let (low, high) = (RINGS[ring], RINGS[ring + 1]);
        mesh.add(&upright(&patch.grid(STEPS), scale, |uv| {
            let y = low + (high - low) * uv.y;
            Vec2::new((quarter + uv.x) * 0.5, 1.0 - y / HEIGHT)
        }));
    }
    mesh
}

/// Handle and spout; s goes round the limb, t along it from the body.
pub(super) fn limbs(scale: f32) -> Mesh {
    let mut mesh = Mesh::default();
    for (k, patch) in (0u8..32).zip(teapot::patches()).skip(24) {
        let (side, stretch) = (f32::from(k % 2), f32::from(k / 2 % 2));
        // The handle ends in the body: it stays short of the gold at the spout's tip.
        let reach = if k < 28 { 0.86 } else { 1.0 };
        mesh.add(&upright(&patch.grid(STEPS), scale, |uv| {
            Vec2::new((side + uv.x) * 0.5, (stretch + uv.y) * 0.5 * reach)
        }));
    }
    mesh
}

/// From z up to y up, with other texture coordinates.
fn upright(grid: &SurfaceMesh, scale: f32, st: impl Fn(Vec2) -> Vec2) -> Mesh {
    let turned = |p: &Vec3| Vec3::new(p.x, p.z, -p.y);
    let area = |t: &&[u32; 3]| {
        let [a, b, c] = t.map(|i| grid.positions[i as usize]);
        (b - a).cross(c - a).length_squared() > 0.0
    };
    Mesh {
        positions: grid.positions.iter().map(|p| turned(p) * scale).collect(),
        normals: grid.normals.iter().map(turned).collect(),
        uv: grid.uv.iter().map(|uv| st(*uv)).collect(),
        triangles: grid.triangles.iter().filter(area).copied().collect(),
        ..Mesh::default()
    }
}
