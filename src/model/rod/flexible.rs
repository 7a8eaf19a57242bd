//! The modes of a flexible rod as the scene gives them.

use super::beam;
use super::counts::Counts;
use crate::math::Vec2;
use crate::model::body::Body;
use crate::scene::modal::{MAX_MODES, ModalTable};
use crate::scene::{Flexible, Scene};

/// The modes of a flexible rod that the scene selects.
#[derive(Clone, Debug)]
pub struct Rod {
    pub(super) counts: Counts,
    /// [m] Undeformed length l.
    pub(super) length: f64,
    /// [kg] Mass.
    pub(super) mass: f64,
    /// [kg·m] ∫B dm, with B the functions along the rod.
    pub(super) first: Vec<f64>,
    /// [kg·m²] ∫B·Bᵀ dm, row by row.
    pub(super) second: Vec<f64>,
    /// [kg·m] ∫B·φᵀ dm, row by row.
    pub(super) coupling: Vec<f64>,
    /// [kg] ∫φ dm.
    pub(super) moment: Vec<f64>,
    /// φ(l/2), φ'(0) and φ'(l) of the bending modes.
    pub(super) middle: Vec<f64>,
    pub(super) slope: [Vec<f64>; 2],
    /// B(l): values of the functions at the small end.
    pub(super) end: Vec<f64>,
    /// [kg] Modal masses of the modal coordinates η.
    pub(super) modal_mass: Vec<f64>,
    /// [rad/s] Natural angular frequencies of η.
    pub frequency: Vec<f64>,
    pub(super) damping_ratio: f64,
}

impl Rod {
    /// The rod of a scene; `None` if it is rigid.
    pub fn new(scene: &Scene) -> Option<Self> {
        let Flexible { bending_modes, axial_modes, damping_ratio, geometric_stiffness, table, .. } =
            &scene.rod.flexible;
        let count = |modes: i32| usize::try_from(modes).unwrap_or(0).min(MAX_MODES);
        let (bending, axial) = (count(*bending_modes), count(*axial_modes));
        if bending + axial == 0 {
            return None;
        }
        let built_in;
        let table = match table {
            Some(table) => table,
            None => {
                built_in = beam::table(scene);
                &built_in
            }
        };
        Some(Self::of(table, bending, axial, scene.rod.length, *damping_ratio, *geometric_stiffness))
    }

    /// The first `bending` bending and `axial` axial modes of a table, with foreshortening if `shortens`.
    fn of(table: &ModalTable, bending: usize, axial: usize, length: f64, damping_ratio: f64, shortens: bool) -> Self {
        let all = table.bending.len();
        let mut kept: Vec<usize> = (0..=axial).collect();
        let mut place = 1 + table.axial.len();
        for i in 0..all {
            for j in i..all {
                if shortens && j < bending {
                    kept.push(place);
                }
                place += 1;
            }
        }
        let (bend, stretch) = (&table.bending[..bending], &table.axial[..axial]);
        let mut end = vec![length];
        end.extend(stretch.iter().map(|mode| mode.end));
        end.extend(kept[1 + axial..].iter().map(|&k| table.shortening[k - 1 - table.axial.len()]));
        let of_modes = |of_bending: &dyn Fn(usize) -> f64, of_axial: &dyn Fn(usize) -> f64| {
            (0..bending).map(of_bending).chain((0..axial).map(of_axial)).collect::<Vec<f64>>()
        };
        Self {
            counts: Counts { bending, axial, shortening: if shortens { bending } else { 0 } },
            length,
            mass: table.mass,
            first: kept.iter().map(|&k| table.first[k]).collect(),
            second: kept.iter().flat_map(|&k| kept.iter().map(move |&m| table.second[k][m])).collect(),
            coupling: kept.iter().flat_map(|&k| table.coupling[k][..bending].iter().copied()).collect(),
            moment: bend.iter().map(|mode| mode.moment).collect(),
            middle: bend.iter().map(|mode| mode.middle).collect(),
            slope: [
                bend.iter().map(|mode| mode.slope_start).collect(),
                bend.iter().map(|mode| mode.slope_end).collect(),
            ],
            end,
            modal_mass: of_modes(&|i| bend[i].mass, &|j| stretch[j].mass),
            frequency: of_modes(&|i| bend[i].frequency, &|j| stretch[j].frequency),
            damping_ratio,
        }
    }

    /// The same rod with more modes, as many as `counts` says. Those that are added stand still: they have a modal mass of 1 kg,
    /// and neither stiffness nor coupling.
    pub(super) fn padded(&self, counts: Counts) -> Self {
        let (own, all) = (self.counts, counts.functions());
        let axial = (0..own.axial).map(|j| 1 + j);
        let functions: Vec<usize> =
            std::iter::once(0).chain(axial).chain(own.all_pairs().map(|(i, j)| counts.pair(i, j))).collect();
        let modes: Vec<usize> = (0..own.bending).chain((0..own.axial).map(|j| counts.bending + j)).collect();
        let spread = |numbers: &[f64], places: &[usize], mut list: Vec<f64>| {
            places.iter().zip(numbers).for_each(|(place, number)| list[*place] = *number);
            list
        };
        let of_functions = |numbers: &[f64]| spread(numbers, &functions, vec![0.0; all]);
        let of_bending = |numbers: &[f64]| spread(numbers, &modes, vec![0.0; counts.bending]);
        let (mut second, mut coupling) = (vec![0.0; all * all], vec![0.0; all * counts.bending]);
        for added in 1 + own.axial..1 + counts.axial {
            second[added * all + added] = 1.0;
        }
        for (k, &row) in functions.iter().enumerate() {
            let numbers = &self.second[k * functions.len()..][..functions.len()];
            functions.iter().zip(numbers).for_each(|(column, number)| second[row * all + column] = *number);
            coupling[row * counts.bending..][..own.bending]
                .copy_from_slice(&self.coupling[k * own.bending..][..own.bending]);
        }
        Self {
            counts,
            first: of_functions(&self.first),
            second,
            coupling,
            moment: of_bending(&self.moment),
            middle: of_bending(&self.middle),
            slope: self.slope.each_ref().map(|slopes| of_bending(slopes)),
            end: of_functions(&self.end),
            modal_mass: spread(&self.modal_mass, &modes, vec![1.0; counts.modes()]),
            frequency: spread(&self.frequency, &modes, vec![0.0; counts.modes()]),
            ..*self
        }
    }

    /// The undeformed rod as a rigid body.
    pub fn undeformed(&self) -> Body {
        let com = Vec2::new(self.first[0] / self.mass, 0.0);
        let inertia = self.second[0] - self.mass * com.x * com.x;
        Body { mass: self.mass, inertia, com, length: self.length }
    }

    /// Number of modal coordinates.
    pub fn modes(&self) -> usize {
        self.counts.modes()
    }

    /// [kg] Mass.
    pub fn mass(&self) -> f64 {
        self.mass
    }
}
