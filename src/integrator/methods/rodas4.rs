//! RODAS: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed. 1996, IV.7 and
//! IV.10; order 4(3), stiffly accurate, L-stable; coefficients as in the authors' rodas.f.

use crate::integrator::rosenbrock::{Coefficients, Implicit, Rosenbrock};

/// The L-stable order-4 pair of six stages.
pub type Rodas4 = Implicit<Rodas>;

/// Its coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Rodas;

const A51: f64 = 0.122_122_450_922_664_1e1;
const A52: f64 = 0.601_913_448_128_862_9e1;
const A53: f64 = 0.125_370_833_293_208_7e2;
const A54: f64 = -0.687_886_036_105_895_0;

impl Rosenbrock for Rodas {
    const NAME: &'static str = "rodas4";
    const COEFFICIENTS: Coefficients = Coefficients {
        order: 4,
        gamma: 0.25,
        nodes: [0.0, 0.386, 0.21, 0.63, 1.0, 1.0],
        slopes: [0.25, -0.1043, 0.1035, -0.036_200_000_000_000_23, 0.0, 0.0],
        a: [
            [0.0; 6],
            [0.1544e1, 0.0, 0.0, 0.0, 0.0, 0.0],
            [0.946_678_528_081_582_6, 0.255_701_169_898_328_4, 0.0, 0.0, 0.0, 0.0],
            [0.331_482_518_706_852_1e1, 0.289_612_401_597_220_1e1, 0.998_641_913_997_781_7, 0.0, 0.0, 0.0],
            [A51, A52, A53, A54, 0.0, 0.0],
            [A51, A52, A53, A54, 1.0, 0.0],
        ],
        c: [
            [0.0; 6],
            [-0.566_88e1, 0.0, 0.0, 0.0, 0.0, 0.0],
            [-0.243_009_335_683_387_5e1, -0.206_359_915_709_191_5, 0.0, 0.0, 0.0, 0.0],
            [-0.107_352_905_815_137_5, -0.959_456_225_102_335_5e1, -0.204_702_861_480_961_6e2, 0.0, 0.0, 0.0],
            [
                0.749_644_331_396_764_7e1,
                -0.102_468_043_146_435_2e2,
                -0.339_999_035_281_990_5e2,
                0.117_089_089_320_616_0e2,
                0.0,
                0.0,
            ],
            [
                0.808_324_679_592_152_2e1,
                -0.798_113_298_806_489_3e1,
                -0.315_215_943_287_437_1e2,
                0.163_193_054_312_313_6e2,
                -0.605_881_823_883_405_4e1,
                0.0,
            ],
        ],
        weights: [A51, A52, A53, A54, 1.0, 1.0],
        error: [0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
    };
}
