//! Moving a camera until all of a box is in its picture.

use arsc_geometry::Aabb;
use glam::DVec3;

use super::{Projection, View};

impl View {
    /// The view in the same direction that shows all of `bounds` (finite, not empty) as large as can be, with `margin`
    /// of the picture, in [0, 1), left free at its edges. The target becomes the middle of the box. A perspective
    /// camera keeps its field of view and moves; an orthographic one changes its extent and stands before the box. `None`
    /// for projections that see in all directions.
    pub fn fitted(&self, bounds: &Aabb, margin: f64) -> Option<View> {
        let axes = self.axes();
        let target = bounds.center();
        let half = self.half_size() * (1.0 - margin);
        let corners = bounds.corners().map(|corner| {
            let p = corner - target;
            DVec3::new(p.dot(axes.right).abs(), p.dot(axes.down).abs(), p.dot(axes.forward))
        });
        let radius = 0.5 * bounds.extent().length();
        let mut view = View { target, ..self.clone() };
        let distance = match &mut view.projection {
            Projection::Perspective { fov, across, .. } => {
                let slope = half * ((0.5 * *fov).tan() / self.half_length(*across));
                let needed = |p: &DVec3| (p.x / slope.x).max(p.y / slope.y) - p.z;
                corners.iter().map(needed).fold(0.0, f64::max)
            }
            Projection::Orthographic { extent, across } => {
                let per_height = |p: &DVec3| (p.x / half.x).max(p.y / half.y);
                let scale = corners.iter().map(per_height).fold(0.0, f64::max);
                *extent = 2.0 * self.half_length(*across) * scale;
                2.0 * radius
            }
            Projection::Fisheye { .. } | Projection::Panorama => return None,
        };
        // A single point is looked at from somewhere, too.
        let distance = if distance > 0.0 { distance } else { 1.0 };
        if let Projection::Orthographic { extent, .. } = &mut view.projection
            && *extent <= 0.0
        {
            *extent = 1.0;
        }
        view.eye = target - axes.forward * distance;
        Some(view)
    }
}
