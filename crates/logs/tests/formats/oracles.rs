//! Other programs read the same logs.
