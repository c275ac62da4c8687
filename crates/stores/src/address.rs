//! Names in stores: `SERVICE://BUCKET/NAME`.

use crate::error::{StoreError, name_fault};
use object_store::path::Path;
use url::Url;

/// What keeps the files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Service {
    /// Amazon S3 and everything that speaks its protocol.
    S3,
    /// Google Cloud Storage.
    Google,
    /// Azure Blob Storage.
    Azure,
    /// A web server; folders are listed where it speaks WebDAV.
    Web,
}

/// Services by the beginning of an address.
const SERVICES: [(&str, Service); 5] = [
    ("s3://", Service::S3),
    ("gs://", Service::Google),
    ("az://", Service::Azure),
    ("http://", Service::Web),
    ("https://", Service::Web),
];

/// The name of a file or folder in a store.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Address {
    pub(crate) service: Service,
    /// Service and bucket, as `s3://bucket`, or a server, as `https://host:port`.
    pub(crate) root: String,
    /// The bucket, the container or the server without its service.
    pub(crate) bucket: String,
    /// The name below the bucket.
    pub(crate) key: Path,
    pub(crate) is_folder: bool,
}

impl Address {
    /// Reads an address.
    ///
    /// # Errors
    /// No known service; no bucket; a name with an empty part; a password or a query in the address of a web server.
    pub fn parse(text: &str) -> Result<Self, StoreError> {
        let bad = |why: &str| StoreError::BadAddress(why.to_owned());
        let (begin, service) = service_of(text).ok_or_else(|| bad("this is no address in a store"))?;
        let rest = text.get(begin.len()..).unwrap_or_default();
        let (bucket, name) = rest.split_once('/').unwrap_or((rest, ""));
        if bucket.is_empty() {
            return Err(bad("this address names no bucket or server"));
        }
        if bucket.contains('@') {
            return Err(bad("an address may not contain a password, because addresses are written into the results"));
        }
        if service == Service::Web && name.contains(['?', '#']) {
            return Err(bad("the address of a web server may not end with a query (a ? and text after it)"));
        }
        let is_folder = name.is_empty() || name.ends_with('/');
        let name = name.strip_suffix('/').unwrap_or(name);
        // names in buckets are text as it stands, those of web servers are encoded
        let key = if service == Service::Web { Path::from_url_path(name) } else { Path::parse(name) };
        let key = key.map_err(|error| StoreError::BadAddress(name_fault(&error)))?;
        Ok(Self { service, root: format!("{begin}{bucket}"), bucket: bucket.to_owned(), key, is_folder })
    }

    /// The address of another name in the same store.
    pub(crate) fn with_key(&self, key: Path) -> Self {
        Self { key, is_folder: false, ..self.clone() }
    }

    /// What keeps the file.
    pub fn service(&self) -> Service {
        self.service
    }

    /// Whether the text ends as the name of a folder does.
    pub fn is_folder(&self) -> bool {
        self.is_folder
    }

    /// The address as text, which reads back as the same one.
    pub fn text(&self) -> String {
        match Url::parse(&self.root) {
            Ok(mut url) if self.service == Service::Web => {
                if let Ok(mut segments) = url.path_segments_mut() {
                    segments.clear().extend(self.key.parts().map(|part| part.as_ref().to_owned()));
                }
                url.into()
            }
            _ => format!("{}/{}", self.root, self.key),
        }
    }
}

fn service_of(text: &str) -> Option<(&'static str, Service)> {
    SERVICES
        .into_iter()
        .find(|(begin, _)| text.get(..begin.len()).is_some_and(|start| start.eq_ignore_ascii_case(begin)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_reads_back_as_itself() {
        for text in [
            "s3://bucket/a b/ü%20.wav",
            "gs://b/x",
            "az://c/x.mov",
            "https://host:8080/a%20b/c.wav",
            "http://[::1]:9/c.wav",
        ] {
            let address = Address::parse(text).unwrap();
            assert_eq!(Address::parse(&address.text()).unwrap(), address, "{text}");
        }
        assert_eq!(Address::parse("s3://bucket/a b/ü%20.wav").unwrap().text(), "s3://bucket/a b/ü%20.wav");
        assert_eq!(Address::parse("https://h/a%20b.wav").unwrap().key.as_ref(), "a b.wav");
    }

    #[test]
    fn what_is_no_address_is_refused() {
        for text in [
            "",
            "archive",
            "ftp://host/x",
            "s3://",
            "s3:///x",
            "https://name:word@host/x",
            "https://host/x?key=1",
            "s3://b/a//b",
        ] {
            assert!(matches!(Address::parse(text), Err(StoreError::BadAddress(_))), "{text}");
        }
        assert!(Address::parse("S3://b").unwrap().is_folder());
    }
}
