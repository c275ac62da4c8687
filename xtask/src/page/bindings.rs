//! From a module to the module and script that a page imports.

use std::path::Path;
use wasm_bindgen_cli_support::Bindgen;

/// Writes `hovertone.js`, its types and `hovertone_bg.wasm`.
pub(super) fn write(module: &Path, folder: &Path) -> Result<(), String> {
    let mut bindgen = Bindgen::new();
    let made = bindgen.input_path(module).out_name("hovertone").typescript(true).web(true);
    let made =
        made.and_then(|bindgen| bindgen.remove_name_section(true).remove_producers_section(true).generate(folder));
    made.map_err(|error| format!("the bindings could not be made: {error:#}"))
}
