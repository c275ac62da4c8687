//! What speaks against a grey box.

use crate::grey_box::{GreyBoxRecord, MS_PER_S, PERCENT};
use crate::notice::Notice;
use crate::number::significant;
use hovertone_analysis::Warning;
use hovertone_vehicle::in_list;

/// What speaks against the model, each with what to do.
pub fn grey_box_warnings(record: &GreyBoxRecord) -> Vec<Notice> {
    let axes = record.axes_of_negative_gains();
    let gains = (!axes.is_empty()).then(|| {
        let (gains, are) = if axes.len() > 1 { ("gains", "are") } else { ("gain", "is") };
        let what = format!(
            "the {gains} k_p of {} {are} negative (the command answers an error in the wrong direction), and no \
            vehicle can fly with negative gains",
            in_list(&axes, "and")
        );
        Notice::new(what, "check --log-axes, and the signs of the commands and of the measured values in the log")
    });
    let better = record.better.map(Warning::FitsElsewhere);
    let hover = record.other_hover.map(Notice::from);
    let names = record.are_names_doubtful().then(|| {
        Notice::new(
            "the sound hardly shows which rotor is which: two hover speeds may be exchanged, and the gains may be wrong",
            "place the microphone nearer to the vehicle, or use a log that has the speeds of the rotors",
        )
    });
    let echoes = record.echoes.map(|echoes| {
        let what = format!(
            "this place has echoes: {:.0} % of the sound comes from walls, {:.0} ms late on average; the model does not contain that, so gains may be \
            30 % wrong, and the time constant 60 %",
            PERCENT * (1.0 - echoes.direct_share),
            MS_PER_S * echoes.decay_s()
        );
        Notice::new(what, "fly outdoors, or use a log that has the speeds of the rotors")
    });
    let unexplained = record.unexplained().map(|fitted| {
        let what = format!(
            "the model explains too little of this flight: the predicted speeds differ from the speeds in the flight by {} % (rms), and these \
            change by {} % (rms)",
            significant(PERCENT * fitted.rms_share, 2),
            significant(PERCENT * fitted.change_share, 2)
        );
        let hint = "log the command and the measured value of each loop that was flown; the tables show the loops that are left out with –";
        Notice::new(what, hint)
    });
    hover
        .into_iter()
        .chain(names)
        .chain(echoes)
        .chain(gains)
        .chain(unexplained)
        .chain(better.map(|better| Notice::new(better.to_string(), better.hint())))
        .collect()
}
