//! What CI does and a person types.
fn main() {}
