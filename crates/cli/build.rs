//! Puts the page into the program, where the feature `page` asks for it: the folder that `cargo xtask page` wrote.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "page")]
    if let Err(message) = page::embed() {
        println!("cargo::error={message}");
    }
}

#[cfg(feature = "page")]
mod page {
    use flate2::Compression;
    use flate2::write::GzEncoder;
    use std::fmt::Write as _;
    use std::io::Write as _;
    use std::path::{Path, PathBuf};
    use std::{env, fs};

    /// Compresses all files of the page and writes the list of them.
    pub(super) fn embed() -> Result<(), String> {
        println!("cargo::rerun-if-env-changed=HOVERTONE_PAGE");
        let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("cargo names no folder for what is built")?);
        let folder = folder(&out);
        println!("cargo::rerun-if-changed={}", folder.display());
        let missing = |error: std::io::Error| {
            format!("the page is not in {}: run `cargo xtask page` first ({error})", folder.display())
        };
        let mut names = names_in(&folder).map_err(missing)?;
        names.sort();
        let mut list = "const FILES: &[EmbeddedFile] = &[\n".to_owned();
        for name in &names {
            let bytes = fs::read(folder.join(name)).map_err(missing)?;
            let compressed = out.join(format!("{}.gz", name.replace('/', "_")));
            fs::write(&compressed, gzip(&bytes)?).map_err(|error| error.to_string())?;
            writeln!(
                list,
                "    EmbeddedFile {{ name: {name:?}, gzip: include_bytes!({:?}) }},",
                compressed.display().to_string()
            )
            .map_err(|error| error.to_string())?;
        }
        fs::write(out.join("page_files.rs"), list + "];\n").map_err(|error| error.to_string())
    }

    /// The files of a folder and of the folders in it, by their paths from it.
    fn names_in(folder: &Path) -> std::io::Result<Vec<String>> {
        let mut names = Vec::new();
        for entry in fs::read_dir(folder)? {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy().into_owned();
            match entry.file_type()?.is_dir() {
                true => names.extend(names_in(&entry.path())?.iter().map(|inner| format!("{name}/{inner}"))),
                false => names.push(name),
            }
        }
        Ok(names)
    }

    /// Where the page is: as told, or in the folder of what is built.
    fn folder(out: &Path) -> PathBuf {
        let told = env::var_os("HOVERTONE_PAGE").map(PathBuf::from);
        // target/release/build/hovertone-cli-0123/out
        let built = || {
            out.ancestors().find(|folder| folder.join("page/index.html").is_file()).map(|folder| folder.join("page"))
        };
        told.or_else(built).unwrap_or_else(|| PathBuf::from("target/page"))
    }

    fn gzip(bytes: &[u8]) -> Result<Vec<u8>, String> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(bytes).and_then(|()| encoder.finish()).map_err(|error| error.to_string())
    }
}
