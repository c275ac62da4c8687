//! The command as a person runs it: what it prints, what it writes, how it ends.

// The lints know tests by their attribute, and what tests share has none.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout)]

mod absurd_numbers;
mod advice;
#[cfg(feature = "archive")]
mod batch;
#[cfg(feature = "archive")]
mod batch_docs;
mod calibrate;
mod cancelled_channels;
mod changes_nothing;
mod chromium;
mod codecs;
mod contradictions;
mod demo;
mod examples;
mod exit_codes;
mod filing;
mod fit;
mod flight_logs;
mod folded;
mod greybox;
mod hints;
mod identify;
mod interrupts;
mod into;
mod labels;
mod lighthouse;
mod listen;
mod log;
mod messages;
mod microphones;
mod motor;
mod movie;
mod newcomer;
mod nonsense;
mod one_number;
mod outputs;
mod own_vehicles;
mod page;
mod plain_refusals;
mod progress;
mod reading;
mod real_recordings;
mod report;
mod report_fixture;
mod rights;
mod roundtrip;
mod saying_more;
#[cfg(feature = "page")]
mod served;
mod shell;
mod sigint;
mod simulate;
mod slips;
mod spectrogram;
mod speed;
mod spoiled;
mod start;
mod testkit;
mod thrust;
mod tones;
mod unseparated;
mod usage;
mod verify;
