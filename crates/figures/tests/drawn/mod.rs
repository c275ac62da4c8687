//! What a drawing shows: its panels, words and layers.

use roxmltree::{Document, Node};

/// What a drawing shows.
#[derive(Debug, Default)]
pub(crate) struct Structure {
    /// Axes of every panel: place and range.
    pub(crate) panels: Vec<Vec<f64>>,
    pub(crate) words: Vec<String>,
    /// Classes of the layers, and for each the points of all that is drawn in it.
    pub(crate) layers: Vec<(String, Vec<(f64, f64)>)>,
}

pub(crate) fn structure(svg: &str) -> Structure {
    pub(crate) const AXES: [&str; 8] =
        ["data-left", "data-top", "data-right", "data-bottom", "data-x-from", "data-x-to", "data-y-from", "data-y-to"];
    let drawn = Document::parse(svg).unwrap();
    let number = |node: Node<'_, '_>, name: &str| node.attribute(name).unwrap().parse::<f64>().unwrap();
    let mut structure = Structure::default();
    for group in drawn.root_element().children().filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "g"))) {
        let class = group.attribute("class").unwrap().to_owned();
        if class == "panel" {
            structure.panels.push(AXES.map(|name| number(group, name)).to_vec());
        }
        let inside = || group.descendants();
        structure
            .words
            .extend(inside().filter_map(|node| Some(node.text()?.trim().to_owned())).filter(|text| !text.is_empty()));
        let points = inside().flat_map(|node| match node.tag_name().name() {
            "polyline" | "polygon" => node.attribute("points").unwrap().split_whitespace().map(pair).collect(),
            "circle" => vec![(number(node, "cx"), number(node, "cy"))],
            "rect" | "image" => vec![(number(node, "x"), number(node, "y"))],
            _ => Vec::new(),
        });
        structure.layers.push((class, points.collect()));
    }
    structure
}

pub(crate) fn pair(text: &str) -> (f64, f64) {
    let (x, y) = text.split_once(',').unwrap();
    (x.parse().unwrap(), y.parse().unwrap())
}
