//! A draft as the commented text of an experiment file.

use super::masses::mass_words;
use super::{Draft, LoadDraft};
use crate::args::rounded;
use crate::files::is_pattern;
use hovertone_vehicle::Vehicle;
use std::path::Path;
use toml::Value;

/// Column of the comments.
const COMMENT_COLUMN: usize = 32;
/// How a recording names its log.
const LOG_LINES: &str = "\n# A log of the flight (ULog, DataFlash, blackbox, CSV) tells which rotor is which, and checks the speeds:\n\
                         # recordings = [{ file = \"hover.wav\", log = \"hover.ulg\" }]\n";

impl Draft {
    /// The text of an experiment file: valid, and commented for the person who changes it. `head` is its first comment.
    pub(crate) fn experiment_text(&self, head: &str, vehicle: Option<&Vehicle>) -> String {
        let mut text = format!("{head}\n[vehicle]\n");
        if let Some(preset) = &self.preset {
            let name = vehicle.map_or("", |vehicle| vehicle.name);
            text += &line(
                "preset",
                &quoted(preset),
                &format!("{name}; `hovertone vehicles` lists its numbers and sources"),
            );
        }
        if let Some(rotors) = self.rotors {
            text += &line("rotors", &rotors.to_string(), "all rotors that carry the vehicle");
        }
        if let Some(blades) = self.blades {
            text += &line("blades", &blades.to_string(), "number of blades of each propeller");
        }
        if let Some(gear) = self.gear {
            let value = format!("{{ pinion = {}, wheel = {} }}", gear.pinion, gear.wheel);
            text += &line("gear", &value, "numbers of teeth; the speed is heard from the tone of the gear");
        }
        text += &self.diameter_lines(vehicle);
        text += &line(
            "mass_kg",
            &self.vehicle_mass_kg().to_string(),
            "ready to fly, with battery: the mass of the lightest load",
        );
        text += &line("mass_std_kg", "0.0005", "for a scale that shows whole grams: change it for another scale");
        text += &self.gravity_lines();
        text += match self.height_m {
            Some(_) => {
                "\n[air]                           # for the thrust coefficient C_T; the height alone gives a density too\n"
            }
            None => "\n# [air]                         # for the thrust coefficient C_T\n",
        };
        text += "# temperature_c = 20.0\n# pressure_hpa = 1013.0\n";
        text += &self.tone_lines();
        text += &self.recorder_lines();
        let names = names_of(&self.loads);
        for (load, name) in self.loads.iter().zip(names) {
            text += &self.load_lines(load, &name);
        }
        text + LOG_LINES
    }

    /// The diameter, and why it matters.
    fn diameter_lines(&self, vehicle: Option<&Vehicle>) -> String {
        const WHY: &str = "# With the diameter, hovertone can rule out half and double the true speed. The thrust \
                           coefficient C_T needs it too.\n";
        let of_vehicle = vehicle.and_then(|vehicle| vehicle.propeller_diameter_m).map(|diameter| diameter.value);
        let value = match (self.diameter_m, of_vehicle) {
            (Some(diameter_m), _) => line("propeller_diameter_m", &diameter_m.to_string(), "from tip to tip"),
            (None, Some(diameter_m)) => {
                format!("# propeller_diameter_m = {} # known already from the preset\n", rounded(diameter_m))
            }
            (None, None) => "# propeller_diameter_m = 0.2    # from tip to tip: measure it\n".to_owned(),
        };
        WHY.to_owned() + &value
    }

    fn gravity_lines(&self) -> String {
        let mut text = String::new();
        for (name, value, comment) in [
            ("gravity_m_s2", self.gravity_m_s2, "at the place of the flights"),
            ("latitude_deg", self.latitude_deg, "of the flights, for gravity"),
            ("height_m", self.height_m, "above the sea"),
        ] {
            text += &value.map_or(String::new(), |value| line(name, &value.to_string(), comment));
        }
        if text.is_empty() {
            text += "# latitude_deg = 48.1           # place of the flights: the ± gets smaller, because gravity \
                     differs by 0.5 % on Earth\n";
            text += "# height_m = 500.0              # above the sea\n";
        }
        text
    }

    /// The tone, where more is said of it than that of the blades or of the gear.
    fn tone_lines(&self) -> String {
        if self.band_hz.is_none() && self.harmonics.is_none() {
            return String::new();
        }
        let band = self.band_hz.map(|(low, high)| line("band_hz", &format!("[{low}, {high}]"), "where the tone lies"));
        let harmonics = self
            .harmonics
            .map(|count| line("harmonics", &count.to_string(), "multiples of the tone, itself the first"));
        format!("\n[tone]\n{}{}", band.unwrap_or_default(), harmonics.unwrap_or_default())
    }

    /// The clock of the recorder, where its correction is known.
    fn recorder_lines(&self) -> String {
        self.clock_correction_ppm.map_or(String::new(), |ppm| {
            let value = line("clock_correction_ppm", &ppm.to_string(), "as `hovertone calibrate` prints it");
            format!("\n[recorder]\n{value}")
        })
    }

    fn load_lines(&self, load: &LoadDraft, name: &str) -> String {
        let added_kg = rounded(load.mass_kg - self.vehicle_mass_kg());
        let mut text = format!("\n[[load]]\nname = {}\n", quoted(name));
        text += &line(
            "added_mass_kg",
            &added_kg.to_string(),
            &format!("added to mass_kg above: {} in flight", mass_words(load.mass_kg)),
        );
        text += &match &load.recordings[..] {
            [one] => format!("recordings = [{}]\n", quoted(one)),
            several => {
                let lines: String = several.iter().map(|name| format!("  {},\n", quoted(name))).collect();
                format!("recordings = [\n{lines}]\n")
            }
        };
        text
    }
}

/// The name of each load: that of the folder of its recordings, or of its only recording, else its mass.
fn names_of(loads: &[LoadDraft]) -> Vec<String> {
    let folder = |load: &LoadDraft| -> Option<String> {
        if let [one] = &load.recordings[..]
            && !is_pattern(one)
            && one != "-"
        {
            return Some(Path::new(one).file_stem()?.to_str()?.to_owned());
        }
        let mut folders = load.recordings.iter().map(|name| Path::new(name).parent()?.file_name()?.to_str());
        let first = folders.next()??;
        let is_name = first != ".." && first != "~" && !first.contains(['*', '?']);
        (is_name && folders.all(|folder| folder == Some(first))).then(|| first.to_owned())
    };
    let folders: Vec<Option<String>> = loads.iter().map(folder).collect();
    let is_unique = |name: &String| folders.iter().flatten().filter(|other| *other == name).count() == 1;
    let masses = loads.iter().map(|load| mass_words(load.mass_kg));
    folders.iter().zip(masses).map(|(folder, mass)| folder.clone().filter(is_unique).unwrap_or(mass)).collect()
}

/// `key = value` with its comment.
fn line(key: &str, value: &str, comment: &str) -> String {
    format!("{:COMMENT_COLUMN$}# {comment}\n", format!("{key} = {value} "))
}

fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone::experiment::ExperimentFile;
    use hovertone::thrust::Force;
    use hovertone_vehicle::{Gear, find_preset};

    fn load(mass_kg: f64, recordings: &[&str]) -> LoadDraft {
        LoadDraft { mass_kg, recordings: recordings.iter().map(|name| (*name).to_owned()).collect() }
    }

    #[test]
    fn every_draft_is_a_valid_experiment() {
        let loads = vec![
            load(0.444, &["small/*.mov"]),
            load(0.413, &["no \"hull\" [1]/a.mov", "no \"hull\" [1]/b.mov"]),
            load(0.462, &["~/x.mov"]),
        ];
        let own = Draft {
            rotors: Some(6),
            blades: Some(3),
            gear: Some(Gear { pinion: 8, wheel: 69 }),
            diameter_m: Some(0.2),
            latitude_deg: Some(-20.0),
            height_m: Some(500.0),
            loads: loads.clone(),
            ..Draft::default()
        };
        let of_preset = Draft { preset: Some("ardrone".to_owned()), loads: loads.clone(), ..Draft::default() };
        for (draft, rotors) in [(own, 6), (of_preset, 4)] {
            let vehicle = draft.preset.as_deref().and_then(find_preset);
            let text = draft.experiment_text("# A test.\n", vehicle);
            let file: ExperimentFile = toml::from_str(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
            let experiment = file.resolve(None).unwrap();
            assert_eq!(experiment.rotor_count, rotors);
            assert_eq!(experiment.air.is_some(), draft.height_m.is_some(), "{text}");
            assert!(experiment.is_weighed && text.contains("half and double the true speed"), "{text}");
            let names: Vec<&str> = experiment.loads.iter().map(|load| load.name.as_str()).collect();
            assert_eq!(names, ["small", "no \"hull\" [1]", "x"]);
            for (resolved, typed) in experiment.loads.iter().zip(&loads) {
                let Force::Weight { vehicle_mass_kg, added_mass_kg, .. } = resolved.force else { panic!("a hover") };
                assert!((vehicle_mass_kg + added_mass_kg - typed.mass_kg).abs() < 1e-9);
                let files: Vec<&str> = resolved.recordings.iter().map(|recording| recording.file()).collect();
                assert_eq!(files, typed.recordings);
            }
        }
    }
}
