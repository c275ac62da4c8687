//! `--spin-up`: the order in which the motors were started, by names of the rotors or numbers of the motors.

use crate::failure::Failure;
use hovertone_vehicle::{Layout, Vehicle};

/// Numbers, counted from 1, and names of all rotors in the order of their start.
pub(crate) fn names_of(
    typed: &[String],
    vehicle: Option<&Vehicle>,
    rotors: u32,
) -> Result<Vec<(usize, String)>, Failure> {
    let refused = |what: String| {
        let known = vehicle.and_then(Vehicle::flight_parameters).map(|parameters| places(parameters.layout.value));
        let places = known.unwrap_or_else(|| places(Layout::X));
        let numbers = (1..=rotors).map(|number| number.to_string()).collect::<Vec<_>>().join(",");
        let hint = match rotors as usize == places.len() {
            true => {
                format!(
                    "name each rotor once, as in --spin-up {}, or by motor numbers, as in --spin-up {numbers}",
                    places.join(",")
                )
            }
            false => format!("for {rotors} rotors, give the numbers of the motors, as in --spin-up {numbers}"),
        };
        Failure::usage(what, hint)
    };
    let numbers: Option<Vec<usize>> = typed.iter().map(|name| name.trim().parse().ok()).collect();
    let (all, order) = match numbers {
        Some(numbers) => ((1..=rotors).map(|number| format!("motor {number}")).collect(), numbers),
        None => {
            let layout = vehicle.and_then(Vehicle::flight_parameters).map(|parameters| parameters.layout.value);
            let layouts = layout.map_or(vec![Layout::X, Layout::Plus], |layout| vec![layout]);
            let number_in = |layout: &Layout, name: &str| {
                places(*layout).iter().position(|place| *place == name.trim().to_lowercase()).map(|place| place + 1)
            };
            let numbers_in =
                |layout: &Layout| -> Option<Vec<usize>> { typed.iter().map(|name| number_in(layout, name)).collect() };
            let known = layouts.iter().find_map(|layout| Some((*layout, numbers_in(layout)?)));
            let Some((layout, numbers)) = known else {
                let is_unknown = |name: &&String| layouts.iter().all(|layout| number_in(layout, name).is_none());
                return Err(refused(match typed.iter().find(is_unknown) {
                    Some(unknown) => format!("--spin-up names \"{unknown}\", but no rotor has this name"),
                    None => format!("--spin-up names rotors of two different frames: {}", typed.join(",")),
                }));
            };
            (places(layout).iter().map(|place| place.replace('-', " ")).collect::<Vec<String>>(), numbers)
        }
    };
    let mut sorted = order.clone();
    sorted.sort_unstable();
    if sorted != (1..=all.len()).collect::<Vec<usize>>() || all.len() != rotors as usize {
        return Err(refused(fault_of(&order, &all, rotors)));
    }
    Ok(order.into_iter().map(|number| (number, all[number - 1].clone())).collect())
}

/// What is wrong with numbers that do not name each of the rotors exactly once.
fn fault_of(order: &[usize], all: &[String], rotors: u32) -> String {
    let twice = order.iter().enumerate().find(|(at, number)| order[..*at].contains(number));
    let missing: Vec<&str> =
        (1..).zip(all).filter(|(number, _)| !order.contains(number)).map(|(_, name)| name.as_str()).collect();
    if let Some((_, number)) = twice {
        let name = number.checked_sub(1).and_then(|index| all.get(index));
        let name = name.map_or_else(|| number.to_string(), String::clone);
        return format!("--spin-up must name each of the {rotors} rotors exactly once; it names {name} twice");
    }
    if let Some(number) = order.iter().find(|number| !(1..=all.len()).contains(number)) {
        return format!("--spin-up names motor {number}, but the motors of {rotors} rotors are 1 to {rotors}");
    }
    if all.len() == rotors as usize && order.len() < all.len() {
        return format!(
            "--spin-up must name each of the {rotors} rotors exactly once; it does not name {}",
            missing.join(", ")
        );
    }
    format!("--spin-up names {} rotors, but --rotors or --vehicle says that {rotors} rotors turn", order.len())
}

/// Names of the rotors of a frame as on the command line.
fn places(layout: Layout) -> [String; 4] {
    layout.places(1.0).map(|place| place.name.replace(' ', "-"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(text: &str) -> Vec<String> {
        text.split(',').map(str::to_owned).collect()
    }

    #[test]
    fn rotors_are_named_by_their_places_or_their_numbers() {
        let names = |text: &str, rotors| names_of(&typed(text), None, rotors).unwrap();
        let order = names("front-right,rear-left, Front-Left,rear-right", 4);
        assert_eq!(order.iter().map(|(number, _)| *number).collect::<Vec<_>>(), [4, 2, 1, 3]);
        assert_eq!((order[0].1.as_str(), order[2].1.as_str()), ("front right", "front left"));
        assert_eq!(names("left,front,right,rear", 4)[0], (2, "left".to_owned()));
        assert_eq!(
            names("3,1,2", 3),
            [(3, "motor 3".to_owned()), (1, "motor 1".to_owned()), (2, "motor 2".to_owned())]
        );
    }

    #[test]
    fn counts_that_contradict_each_other_are_named() {
        let what = |text: &str, rotors| match names_of(&typed(text), None, rotors) {
            Err(Failure::Usage { what, hint, .. }) => format!("{what}: {hint}"),
            other => panic!("{other:?}"),
        };
        let six = what("front-right,rear-left,front-left,rear-right", 6);
        assert!(
            six.contains("names 4 rotors, but --rotors or --vehicle says that 6 rotors turn")
                && six.ends_with("--spin-up 1,2,3,4,5,6"),
            "{six}"
        );
        assert!(what("1,2,3", 4).contains("does not name motor 4"));
        assert!(what("1,2,3,3", 4).contains("it names motor 3 twice"));
        assert!(what("0,1,2,3", 4).contains("names motor 0, but the motors of 4 rotors are 1 to 4"));
        assert!(what("1,2,3,4", 3).contains("names motor 4, but the motors of 3 rotors are 1 to 3"));
        assert!(what("left,front,right", 4).contains("does not name rear"));
    }

    #[test]
    fn what_is_not_each_once_is_refused() {
        for (text, rotors) in [
            ("front-right,rear-left,front-left", 4),
            ("front-right,rear-left,front-left,front-left", 4),
            ("front,rear-left,left,right", 4),
            ("front-right,rear-left,front-left,nose", 4),
            ("front-right,rear-left,front-left,rear-right", 6),
            ("1,2,3", 4),
            ("0,1,2,3", 4),
            ("", 4),
        ] {
            assert!(matches!(names_of(&typed(text), None, rotors), Err(Failure::Usage { .. })), "{text}");
        }
    }
}
