//! The icon of the page as pictures of points, for the home screens of phones.

use resvg::{tiny_skia, usvg};
use std::fs;
use std::path::Path;

/// Names of the pictures and their edges in points. Home screens cut the last one to a shape of their own.
const PICTURES: [(&str, u32); 3] = [("icon-192.png", 192), ("icon-512.png", 512), ("icon-cut.png", 512)];
/// Part of a picture that no home screen cuts away.
const KEPT_SHARE: f32 = 0.8;

/// Colour of the icon's ground, which goes on around it where it is cut: red, green, blue.
const GROUND: [u8; 3] = [0x0b, 0x4f, 0x78];

/// Draws all pictures of an icon into a folder.
pub(super) fn write(icon: &Path, out: &Path) -> Result<(), String> {
    let failed = |error: &dyn std::fmt::Display| format!("{}: {error}", icon.display());
    let text = fs::read_to_string(icon).map_err(|error| failed(&error))?;
    let tree = usvg::Tree::from_str(&text, &usvg::Options::default()).map_err(|error| failed(&error))?;
    for (name, edge_px) in PICTURES {
        let mut picture = tiny_skia::Pixmap::new(edge_px, edge_px).ok_or_else(|| failed(&"an icon without points"))?;
        let whole = edge_px as f32 / tree.size().width();
        let is_cut = name == "icon-cut.png";
        if is_cut {
            picture.fill(tiny_skia::Color::from_rgba8(GROUND[0], GROUND[1], GROUND[2], u8::MAX));
        }
        let scale = if is_cut { KEPT_SHARE * whole } else { whole };
        let edge = (edge_px as f32 - scale * tree.size().width()) / 2.0;
        let place = tiny_skia::Transform::from_scale(scale, scale).post_translate(edge, edge);
        resvg::render(&tree, place, &mut picture.as_mut());
        picture.save_png(out.join(name)).map_err(|error| failed(&error))?;
    }
    Ok(())
}
