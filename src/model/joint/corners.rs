//! The slider's four corners as separate contacts.

use super::rectangle::{CORNERS, Rectangle, SliderPose, Surface, SurfaceContact};
use super::revolute::event_function;
use crate::integrator::EventFunction;
use crate::math::Real;
use crate::model::contact::{ContactState, Elastic};

/// The surface whose corners are separate contacts.
pub(super) struct Corners;

impl Surface for Corners {
    const CONTACT_OF_CORNER: [usize; CORNERS] = [0, 1, 2, 3];

    #[inline(always)]
    fn touch<R: Real>(rectangle: &Rectangle, k: usize, pose: &SliderPose<R>) -> SurfaceContact<R> {
        rectangle.corners[k].touch(pose)
    }

    fn approach<R: Real>(rectangle: &Rectangle, k: usize, pose: &SliderPose<R>) -> (R, R) {
        let SurfaceContact { depth, rate, .. } = rectangle.corners[k].touch(pose);
        (depth, rate)
    }

    fn event_functions(rectangle: &Rectangle, states: &[ContactState], pose: &SliderPose) -> [EventFunction; CORNERS] {
        std::array::from_fn(|k| {
            let SurfaceContact { depth, rate, .. } = rectangle.corners[k].touch(pose);
            event_function(&states[k], depth, rate)
        })
    }

    fn energy<R: Real>(rectangle: &Rectangle, elastic: &Elastic, k: usize, pose: &SliderPose<R>) -> R {
        elastic.energy(rectangle.corners[k].touch(pose).depth.max(0.0))
    }
}
