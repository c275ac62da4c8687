//! Stores of the crate `object_store`: one for each bucket, with the credentials of the environment.

use crate::address::{Address, Service};
use crate::error::StoreError;
use object_store::aws::{AmazonS3Builder, AmazonS3ConfigKey};
use object_store::azure::{AzureConfigKey, MicrosoftAzureBuilder};
use object_store::client::ClientConfigKey;
use object_store::gcp::{GoogleCloudStorageBuilder, GoogleConfigKey};
use object_store::http::HttpBuilder;
use object_store::{BackoffConfig, ObjectStore, RetryConfig};
use std::env;
use std::sync::Arc;
use std::time::Duration;

/// Variables with the address of a server that speaks S3.
const ENDPOINTS: [&str; 4] = ["AWS_ENDPOINT_URL_S3", "AWS_ENDPOINT_URL", "AWS_ENDPOINT", "AWS_S3_ENDPOINT"];

/// How long a store is waited for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patience {
    /// Attempts after the first one.
    pub retries_max: usize,
    /// Pause before the second attempt; each next one is about twice as long.
    pub pause_s: f64,
    /// Longest silence within an answer.
    pub silence_s_max: f64,
    /// Longest time of an answer.
    pub answer_s_max: f64,
}

impl Default for Patience {
    /// A store that is busy for some seconds is waited for; one that is gone does not hold a night of work up.
    fn default() -> Self {
        Self { retries_max: 6, pause_s: 0.1, silence_s_max: 20.0, answer_s_max: 180.0 }
    }
}

impl Patience {
    fn retries(self) -> RetryConfig {
        let backoff = BackoffConfig { init_backoff: Duration::from_secs_f64(self.pause_s), ..BackoffConfig::default() };
        let retry_timeout = Duration::from_secs_f64(self.answer_s_max);
        RetryConfig { backoff, max_retries: self.retries_max, retry_timeout }
    }

    /// Settings of the connections, beside those that the environment gives.
    fn times(self) -> [(ClientConfigKey, String); 2] {
        let text = |seconds: f64| format!("{}ms", (1000.0 * seconds).round());
        [(ClientConfigKey::ReadTimeout, text(self.silence_s_max)), (ClientConfigKey::Timeout, text(self.answer_s_max))]
    }
}

/// The store of an address.
pub(crate) fn store_of(address: &Address, patience: Patience) -> Result<Arc<dyn ObjectStore>, StoreError> {
    let (times, retries) = (patience.times().into_iter(), patience.retries());
    let built: Result<Arc<dyn ObjectStore>, object_store::Error> = match address.service {
        Service::S3 => {
            let builder = AmazonS3Builder::from_env().with_bucket_name(&address.bucket).with_retry(retries);
            let endpoint = ENDPOINTS.into_iter().find_map(|name| env::var(name).ok());
            let is_plain = endpoint.is_some_and(|endpoint| endpoint.starts_with("http://"));
            let builder = if is_plain { builder.with_allow_http(true) } else { builder };
            times
                .fold(builder, |builder, (key, value)| builder.with_config(AmazonS3ConfigKey::Client(key), value))
                .build()
                .map(arc)
        }
        Service::Google => {
            let builder = GoogleCloudStorageBuilder::from_env().with_bucket_name(&address.bucket).with_retry(retries);
            times
                .fold(builder, |builder, (key, value)| builder.with_config(GoogleConfigKey::Client(key), value))
                .build()
                .map(arc)
        }
        Service::Azure => {
            let builder = MicrosoftAzureBuilder::from_env().with_container_name(&address.bucket).with_retry(retries);
            times
                .fold(builder, |builder, (key, value)| builder.with_config(AzureConfigKey::Client(key), value))
                .build()
                .map(arc)
        }
        Service::Web => {
            let builder = HttpBuilder::new().with_url(&address.root).with_retry(retries);
            let builder = builder.with_config(ClientConfigKey::AllowHttp, "true");
            times.fold(builder, |builder, (key, value)| builder.with_config(key, value)).build().map(arc)
        }
    };
    built.map_err(|error| {
        let text = error.to_string();
        StoreError::Settings(text.split_once(" error: ").map_or(text.as_str(), |(_, why)| why).to_owned())
    })
}

fn arc(store: impl ObjectStore) -> Arc<dyn ObjectStore> {
    Arc::new(store)
}
