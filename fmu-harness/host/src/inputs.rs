//! Inputs of an FMU during a run, each a profile over time or crank angle.

use crate::trajectory::Trajectory;
use anyhow::{Result, ensure};
use slidercrank::model::signals::Inputs;
use slidercrank::scene::profile::{Profile, ProfileArgument, Profiles};

/// One input variable and its profile.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// The variable.
    pub name: String,
    /// Its values.
    pub profile: Profile,
}

impl Input {
    /// Inputs with constant values.
    pub fn constant(inputs: Inputs) -> Vec<Self> {
        let Inputs { crank_torque, slider_load } = inputs;
        let [crank_torque, slider_load] = [crank_torque, slider_load].map(Profile::Constant);
        of_scene(&Profiles { crank_torque, slider_load })
    }

    /// Whether it depends on the crank's angle.
    pub fn wants_angle(&self) -> bool {
        matches!(self.profile, Profile::Points { against: ProfileArgument::CrankAngle, .. })
    }

    /// Whether it is constant.
    pub fn is_constant(&self) -> bool {
        matches!(self.profile, Profile::Constant(_))
    }
}

/// The inputs of a scene.
pub fn of_scene(profiles: &Profiles) -> Vec<Input> {
    let Profiles { crank_torque, slider_load } = profiles;
    [("crank.torque", crank_torque), ("slider.load", slider_load)]
        .map(|(name, profile)| Input { name: name.into(), profile: profile.clone() })
        .into()
}

/// The columns of a CSV file as profiles over time.
///
/// # Errors
/// If two columns have the same name.
pub fn of_table(table: &Trajectory) -> Result<Vec<Input>> {
    let names = table.names();
    let input = |(place, name): (usize, &String)| {
        ensure!(!names[..place].contains(name), "two columns have the name `{name}`");
        let points = table.times().iter().zip(table.column(name)?).map(|(time, value)| [*time, *value]).collect();
        Ok(Input { name: name.clone(), profile: Profile::Points { against: ProfileArgument::Time, points } })
    };
    names.iter().enumerate().map(input).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_straight_between_its_rows_and_level_outside() {
        let mut table = Trajectory::new(["slider.load".to_owned()]);
        for (time, load) in [(0.0, 1.0), (2.0, 5.0), (3.0, 7.5)] {
            table.push(time, &[load]);
        }
        let inputs = of_table(&table).expect("inputs");
        assert_eq!((inputs.len(), inputs[0].name.as_str()), (1, "slider.load"));
        let profile = &inputs[0].profile;
        assert_eq!(
            [-1.0, 0.0, 0.5, 2.0, 2.5, 9.0].map(|time| profile.value(time, f64::NAN)),
            [1.0, 1.0, 2.0, 5.0, 6.25, 7.5]
        );
    }
}
