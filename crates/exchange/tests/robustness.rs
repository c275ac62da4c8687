//! Whatever is in a file: an answer or an error, never a panic.

use hovertone_exchange::{identified_from_results, model_from_text, table_from_csv};
use proptest::prelude::*;

/// Files of every kind, to be damaged.
const SOUND: [&str; 7] = [
    "<plugin><motorConstant>5.84e-06</motorConstant><momentConstant>0.06</momentConstant></plugin>",
    "<xacro:property name=\"motor_constant\" value=\"8.5e-06\" />",
    "<robot><properties kf=\"3.16e-10\" km=\"7.94e-12\"/><mass value=\"0.027\"/></robot>",
    "quad_params = {\n 'mass': 0.5,\n 'num_rotors': 4,\n 'k_eta': 5.57e-06, # N\n}",
    "quadrotor_dynamics:\n  mass: 0.73\n  thrust_map: [1.3e-06, 0.0038, -1.77]\nrl:\n",
    "real_T C_T = 0.11f;\nreal_T air_density = 1.2f;\nreal_T propeller_diameter = 0.2f;\n",
    "[cf]\nmass = 0.03\nrpm2thrust = [0.0, 0.0, 3.16e-10]\n",
];
const TABLE: &str = "motor,thrust_g,rpm,voltage_V,current_A\na,401,5688,16.66,3.09\na,529,6508,16.61,4.80\n";

fn damaged(text: &str, at: usize, with: &str, cut: usize) -> String {
    let place = |index: usize| text.char_indices().nth(index % text.chars().count()).map_or(0, |(byte, _)| byte);
    let start = place(at);
    let end = text.char_indices().map(|(byte, _)| byte).find(|byte| *byte >= start + cut).unwrap_or(text.len());
    format!("{}{with}{}", &text[..start], &text[end..])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn damaged_models_are_answered(kind in 0..SOUND.len(), at in 0_usize..200, with in "\\PC{0,12}", cut in 0_usize..12) {
        let text = damaged(SOUND[kind], at, &with, cut);
        if let Ok(model) = model_from_text(&text) {
            prop_assert!(model.thrust_constant_n_s2 > 0.0 && model.thrust_constant_n_s2.is_finite());
        }
    }

    #[test]
    fn damaged_tables_are_answered(at in 0_usize..200, with in "\\PC{0,12}", cut in 0_usize..12) {
        if let Ok(table) = table_from_csv(&damaged(TABLE, at, &with, cut)) {
            prop_assert!(table.groups.iter().all(|group| !group.rows.is_empty()));
            let rows = table.groups.iter().flat_map(|group| &group.rows);
            prop_assert!(rows.clone().all(|row| row.speed_rad_s > 0.0 && row.speed_rad_s.is_finite()));
        }
    }

    #[test]
    fn any_text_is_answered(text in "\\PC{0,200}") {
        let _ = model_from_text(&text);
        let _ = table_from_csv(&text);
        prop_assert!(identified_from_results(&text, None).is_err());
    }
}
