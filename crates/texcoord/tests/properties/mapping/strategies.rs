//! Mappings of every kind and points they are asked about.

use glam::{DAffine3, DMat3, DMat4, DVec2, DVec3, DVec4};
use proptest::prelude::*;
use texcoord::mapping::{
    BackFacets, Cube, Cylindrical, Facets, Intermediate, Mapping, ObjectStage, ParallelProjection,
    PerspectiveProjection, PlacedMapping, Placement, PolarConvention, Spherical, SurfacePoint,
    Triplanar, TurnConvention, TwoStage, Viewer,
};

pub(crate) const TURNS: [TurnConvention; 3] = [
    TurnConvention::FromStart,
    TurnConvention::Centred,
    TurnConvention::Signed,
];

pub(crate) const STAGES: [ObjectStage; 4] = [
    ObjectStage::ReflectedRay,
    ObjectStage::ObjectNormal,
    ObjectStage::Centroid,
    ObjectStage::IntermediateNormal,
];

pub(crate) fn vector(reach: f64) -> impl Strategy<Value = DVec3> {
    [-reach..reach, -reach..reach, -reach..reach].prop_map(DVec3::from_array)
}

/// Vectors of at least a tenth.
pub(crate) fn direction() -> impl Strategy<Value = DVec3> {
    vector(1.0).prop_filter("a direction", |v| v.length() > 0.1)
}

pub(crate) fn spherical() -> impl Strategy<Value = Spherical> {
    let poles = [PolarConvention::FromTop, PolarConvention::FromBottom];
    let t = prop::sample::select(poles.to_vec());
    (prop::sample::select(TURNS.to_vec()), t).prop_map(|(s, t)| Spherical { s, t })
}

pub(crate) fn cylindrical() -> impl Strategy<Value = Cylindrical> {
    (0..4, prop::sample::select(TURNS.to_vec()), 0.1..8.0f64).prop_map(|(kind, s, h)| match kind {
        0 => Cylindrical::plain(s),
        1 => Cylindrical::centred(s),
        2 => Cylindrical::of_height(s, h).unwrap(),
        _ => Cylindrical::of_half_height(s, h).unwrap(),
    })
}

pub(crate) fn backs() -> impl Strategy<Value = BackFacets> {
    prop_oneof![Just(BackFacets::Mirrored), Just(BackFacets::Readable)]
}

/// The four surfaces, of sizes around 3: large enough to hold most points of [`surface_point`], not all.
pub(crate) fn intermediate() -> impl Strategy<Value = Intermediate> {
    let size = || 1.0..4.0f64;
    prop_oneof![
        (size(), size(), size())
            .prop_map(|(d, w, h)| Intermediate::plane(d, DVec2::new(w, h)).unwrap()),
        (size(), cylindrical()).prop_map(|(r, chart)| Intermediate::cylinder(r, chart).unwrap()),
        (size(), spherical()).prop_map(|(r, chart)| Intermediate::sphere(r, chart).unwrap()),
        (size(), size(), size())
            .prop_map(|(x, y, z)| Intermediate::cuboid(DVec3::new(x, y, z) * 2.0).unwrap()),
    ]
}

pub(crate) fn two_stage() -> impl Strategy<Value = TwoStage> {
    (intermediate(), prop::sample::select(STAGES.to_vec()))
        .prop_map(|(surface, stage)| TwoStage { surface, stage })
}

pub(crate) fn affine() -> impl Strategy<Value = DAffine3> {
    (vector(1.0), vector(1.0), vector(1.0), vector(1.0)).prop_filter_map(
        "a map that flattens nothing",
        |(x, y, z, shift)| {
            let matrix = DMat3::from_cols(x, y, z);
            (matrix.determinant().abs() > 0.05)
                .then(|| DAffine3::from_mat3_translation(matrix, shift))
        },
    )
}

/// A projector with q between 0.5 and 2.5 where |P| < 1, of any direction; behind it elsewhere.
pub(crate) fn perspective() -> impl Strategy<Value = PerspectiveProjection> {
    (affine(), direction()).prop_map(|(map, ahead)| {
        let mut matrix = DMat4::from(map);
        let q = ahead.normalize().extend(1.5);
        for (k, column) in [0, 1, 2, 3].into_iter().zip(q.to_array()) {
            matrix.col_mut(k).w = column;
        }
        PerspectiveProjection::new(matrix).unwrap()
    })
}

pub(crate) fn mapping() -> impl Strategy<Value = Mapping> {
    prop_oneof![
        1 => affine().prop_map(|m| Mapping::Parallel(ParallelProjection::new(m).unwrap())),
        1 => perspective().prop_map(Mapping::Perspective),
        1 => backs().prop_map(|backs| Mapping::Facets(Facets { backs })),
        1 => (1.0..9.0f64, backs())
            .prop_map(|(k, backs)| Mapping::Triplanar(Triplanar::new(k, backs).unwrap())),
        1 => spherical().prop_map(Mapping::Spherical),
        1 => cylindrical().prop_map(Mapping::Cylindrical),
        1 => Just(Mapping::Cube(Cube)),
        4 => two_stage().prop_map(Mapping::TwoStage),
    ]
}

pub(crate) fn placed_mapping() -> impl Strategy<Value = PlacedMapping> {
    let placement = prop_oneof![
        Just(Placement::Z_UP),
        Just(Placement::Y_UP),
        Just(Placement::X_UP),
        affine().prop_map(|map| Placement::new(map).unwrap()),
    ];
    (placement, mapping()).prop_map(|(placement, mapping)| PlacedMapping { placement, mapping })
}

fn viewer() -> impl Strategy<Value = Viewer> {
    prop_oneof![
        direction().prop_map(|v| Viewer::At(v * 6.0)),
        direction().prop_map(Viewer::Toward),
    ]
}

pub(crate) fn surface_point() -> impl Strategy<Value = SurfacePoint> {
    let steps = (vector(1.0), vector(1.0), vector(1.0), vector(1.0));
    (vector(2.0), direction(), viewer(), steps).prop_map(
        |(position, normal, viewer, (a, b, c, d))| SurfacePoint {
            position,
            normal,
            viewer,
            dposition_dx: a,
            dposition_dy: b,
            dnormal_dx: c,
            dnormal_dy: d,
        },
    )
}

/// One mapping of each kind, of size 1: the rows of the tables of hard cases.
pub(crate) fn one_of_each() -> Vec<Mapping> {
    let chart = Cylindrical::centred(TurnConvention::Centred);
    let surfaces = [
        Intermediate::plane(1.0, DVec2::ONE),
        Intermediate::cylinder(1.0, chart),
        Intermediate::sphere(1.0, Spherical::PHI_THETA),
        Intermediate::cuboid(DVec3::ONE),
    ];
    let slide = DMat4::from_cols(
        DVec4::X,
        DVec4::Y,
        DVec4::new(0.0, 0.0, 1.0, 1.0),
        DVec4::ZERO,
    );
    let mut all = vec![
        Mapping::Parallel(ParallelProjection::new(DAffine3::IDENTITY).unwrap()),
        Mapping::Perspective(PerspectiveProjection::new(slide).unwrap()),
        Mapping::Facets(Facets::default()),
        Mapping::Triplanar(Triplanar::new(4.0, BackFacets::Readable).unwrap()),
        Mapping::Spherical(Spherical::PHI_THETA),
        Mapping::Spherical(Spherical::ATAN2_ARCCOS),
        Mapping::Cylindrical(chart),
        Mapping::Cube(Cube),
    ];
    for surface in surfaces {
        let surface = surface.unwrap();
        all.extend(STAGES.map(|stage| Mapping::TwoStage(TwoStage { surface, stage })));
    }
    all
}
