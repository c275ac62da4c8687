//! Plans of fast Fourier transforms. The transforms are generic over the number type, so that each crate that plans one builds all of
//! them again; here they are built once for the workspace.

use realfft::{ComplexToReal, FftNum, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

/// Plans of complex transforms in `f32`, kept by length.
#[derive(Default)]
pub struct ComplexPlanner {
    planner: Option<FftPlanner<f32>>,
}

impl ComplexPlanner {
    /// A planner without plans.
    pub fn new() -> Self {
        Self::default()
    }

    /// `X[k] = Σ_n x[n] e^(−j2πkn/N)`, without a scale. N = `length`.
    #[inline(never)]
    pub fn forward(&mut self, length: usize) -> Arc<dyn Fft<f32>> {
        self.planner.get_or_insert_with(FftPlanner::new).plan_fft_forward(length)
    }

    /// `x[n] = Σ_k X[k] e^(j2πkn/N)`, without a scale. N = `length`.
    #[inline(never)]
    pub fn inverse(&mut self, length: usize) -> Arc<dyn Fft<f32>> {
        self.planner.get_or_insert_with(FftPlanner::new).plan_fft_inverse(length)
    }
}

/// Plan of the transform of `length / 2 + 1` bins back to `length` real samples, without a scale.
#[inline(never)]
pub fn real_inverse(length: usize) -> Arc<dyn ComplexToReal<f32>> {
    RealFftPlanner::new().plan_fft_inverse(length)
}

/// A number type in which real signals are transformed.
pub trait TransformNumber: FftNum + From<f32> + Into<f64> {
    /// Plan of the transform of `length` real samples to `length / 2 + 1` bins, without a scale.
    fn real_forward(length: usize) -> Arc<dyn RealToComplex<Self>>;
}

impl TransformNumber for f32 {
    #[inline(never)]
    fn real_forward(length: usize) -> Arc<dyn RealToComplex<Self>> {
        RealFftPlanner::new().plan_fft_forward(length)
    }
}

impl TransformNumber for f64 {
    #[inline(never)]
    fn real_forward(length: usize) -> Arc<dyn RealToComplex<Self>> {
        RealFftPlanner::new().plan_fft_forward(length)
    }
}
