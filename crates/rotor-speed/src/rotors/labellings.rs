//! All ways in which the tracks of a frame can be those of the rotors, and what each costs.

/// More rotors than this have too many permutations: they keep their tracks. *Numeric.*
const ROTORS_MAX: usize = 4;
/// The labelling in which each rotor is the track of its own number. *Numeric.*
pub(super) const UNCHANGED: usize = 0;

/// All labellings of the tracks of a frame.
pub(super) struct Labellings {
    /// The track of each rotor. The first is [`UNCHANGED`].
    pub(super) all: Vec<Vec<usize>>,
    /// For each labelling of a frame, each of the frame before, and each rotor: its step among those of all tracks to all tracks.
    steps: Vec<usize>,
}

impl Labellings {
    /// Those of so many tracks: all permutations, or where these are too many, only the one that changes nothing.
    pub(super) fn of(count: usize) -> Self {
        Self::of_all(if count <= ROTORS_MAX { permutations(count) } else { vec![(0..count).collect()] })
    }

    fn of_all(all: Vec<Vec<usize>>) -> Self {
        let count = all[UNCHANGED].len();
        let step = move |(from, to): (&usize, &usize)| from * count + to;
        let steps_to = |to: &Vec<usize>| all.iter().flat_map(|from| from.iter().zip(to).map(step)).collect::<Vec<_>>();
        Self { steps: all.iter().flat_map(steps_to).collect(), all }
    }

    /// The cost of a change from a labelling to another one, where `steps` are the costs of each track to each track.
    pub(super) fn cost_of_change(&self, from: usize, to: usize, steps: &[f64]) -> f64 {
        let count = self.all[UNCHANGED].len();
        let first = (to * self.all.len() + from) * count;
        self.steps[first..first + count].iter().map(|&step| steps[step]).sum()
    }

    /// The cost of each labelling, where `costs` are those of each rotor to be each track.
    pub(super) fn costs(&self, costs: &[Vec<f64>]) -> Vec<f64> {
        let cost = |labelling: &Vec<usize>| labelling.iter().zip(costs).map(|(&track, costs)| costs[track]).sum();
        self.all.iter().map(cost).collect()
    }
}

fn permutations(count: usize) -> Vec<Vec<usize>> {
    if count == 0 {
        return vec![Vec::new()];
    }
    let shorter = permutations(count - 1);
    let with_last_at = |place: usize| {
        shorter.iter().map(move |shorter| {
            let mut longer = shorter.clone();
            longer.insert(place, count - 1);
            longer
        })
    };
    (0..count).rev().flat_map(with_last_at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn permutations_are_all_there_once() {
        let all = permutations(4);
        assert_eq!((all.len(), &all[0]), (24, &vec![0, 1, 2, 3]));
        let distinct: std::collections::BTreeSet<_> = all.iter().collect();
        assert_eq!(distinct.len(), 24);
    }
}
