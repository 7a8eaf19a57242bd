//! The FMU's picture is the drawing beside it.

use resvg::{tiny_skia, usvg};
use std::path::Path;

/// `BLESS=1` writes the picture anew.
#[test]
fn the_picture_is_the_drawing() {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    let drawing = std::fs::read_to_string(assets.join("model.svg")).expect("the drawing");
    let tree = usvg::Tree::from_str(&drawing, &usvg::Options::default()).expect("an SVG");
    let size = tree.size().to_int_size();
    let mut drawn = tiny_skia::Pixmap::new(size.width(), size.height()).expect("a size");
    resvg::render(&tree, tiny_skia::Transform::default(), &mut drawn.as_mut());
    let file = assets.join("model.png");
    if std::env::var_os("BLESS").is_some() {
        drawn.save_png(&file).expect("written");
    }
    let picture = tiny_skia::Pixmap::load_png(&file).expect("the picture");
    assert!(picture.data() == drawn.data(), "assets/model.png is stale: set BLESS=1");
}
