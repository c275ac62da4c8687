//! ARCHITECTURE.md names every crate, in the heading of a section, `## crates/X`, and in that section every folder of its `src`,
//! as `` `folder/` ``.

use super::fault::Fault;
use crate::tree::Tree;
use std::collections::BTreeSet;

const DOCUMENT: &str = "ARCHITECTURE.md";
const HEADING: &str = "## crates/";

pub(super) fn check(tree: &Tree) -> Vec<Fault> {
    let sections = sections(&tree.architecture);
    let crates: BTreeSet<&str> = tree.crate_names().into_iter().filter(|name| *name != "xtask").collect();
    let mut faults = Vec::new();
    for name in &crates {
        let Some(section) = sections.iter().find(|section| section.crate_name == *name) else {
            let line = tree.architecture.lines().count().max(1);
            let message =
                format!("crates/{name} has no section: add the heading \"{HEADING}{name}\" and what the crate does");
            faults.push(Fault::new(DOCUMENT, line, message));
            continue;
        };
        for folder in folders(tree, name) {
            if !section.text.contains(&format!("`{folder}/`")) {
                let message = format!(
                    "crates/{name}/src/{folder} is not named: add a line with `{folder}/` and what is in it to the section \
                     \"{HEADING}{name}\""
                );
                faults.push(Fault::new(DOCUMENT, section.line, message));
            }
        }
    }
    for section in sections.iter().filter(|section| !crates.contains(section.crate_name)) {
        let message = format!("there is no crates/{}: remove its section", section.crate_name);
        faults.push(Fault::new(DOCUMENT, section.line, message));
    }
    faults
}

/// Folders directly under `src`.
fn folders<'tree>(tree: &'tree Tree, crate_name: &str) -> BTreeSet<&'tree str> {
    let of_crate = tree.sources.iter().filter(|source| source.crate_name == crate_name);
    of_crate.filter_map(|source| Some(source.below_src()?.split_once('/')?.0)).collect()
}

/// What stands between the heading of a crate and the next heading of the same or a higher level.
struct Section<'text> {
    crate_name: &'text str,
    line: usize,
    text: String,
}

fn sections(document: &str) -> Vec<Section<'_>> {
    let mut sections: Vec<Section<'_>> = Vec::new();
    let mut is_open = false;
    for (index, line) in document.lines().enumerate() {
        if let Some(name) = line.strip_prefix(HEADING) {
            let crate_name = name.split([' ', ':']).next().unwrap_or(name);
            sections.push(Section { crate_name, line: index + 1, text: String::new() });
            is_open = true;
        } else if line.starts_with("# ") || line.starts_with("## ") {
            is_open = false;
        } else if let Some(section) = sections.last_mut().filter(|_| is_open) {
            section.text.push_str(line);
            section.text.push('\n');
        }
    }
    sections
}

#[cfg(test)]
mod tests {
    use super::check;
    use crate::tree::Tree;

    fn messages(document: &str) -> Vec<String> {
        let tree = Tree::of(&[
            ("ARCHITECTURE.md", document),
            ("crates/a/src/lib.rs", ""),
            ("crates/a/src/room/part/mod.rs", ""),
            ("crates/a/tests/kit/mod.rs", ""),
            ("crates/a-b/src/lib.rs", ""),
            ("xtask/src/tidy/mod.rs", ""),
        ]);
        check(&tree).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_document_that_names_all_has_no_fault() {
        assert!(
            messages("# All\n\n## crates/a\n\n| `room/` | a room |\n### More\n\n## crates/a-b\n## Why\n").is_empty()
        );
        assert!(messages("## crates/a: letters\n### Rooms\n- `room/` a room\n## crates/a-b").is_empty());
    }

    #[test]
    fn a_crate_without_a_section_is_a_fault() {
        assert_eq!(
            messages("# All\n## crates/a\n`room/`\n"),
            ["ARCHITECTURE.md:3: crates/a-b has no section: add the heading \"## crates/a-b\" and what the crate does"]
        );
        assert_eq!(messages("").len(), 2);
    }

    #[test]
    fn a_folder_is_named_in_the_section_of_its_crate() {
        let missing = "ARCHITECTURE.md:1: crates/a/src/room is not named: add a line with `room/` and what is in it to the \
                       section \"## crates/a\"";
        assert_eq!(messages("## crates/a\n## crates/a-b\n`room/`\n"), [missing]);
        assert_eq!(messages("## crates/a\nroom/\n## crates/a-b\n"), [missing]);
        assert_eq!(messages("## crates/a\n## Flow\n`room/`\n## crates/a-b\n"), [missing]);
    }

    #[test]
    fn a_section_of_no_crate_is_a_fault() {
        let found = messages("## crates/a\n`room/`\n## crates/a-b\n## crates/gone\n");
        assert_eq!(found, ["ARCHITECTURE.md:4: there is no crates/gone: remove its section"]);
    }
}
