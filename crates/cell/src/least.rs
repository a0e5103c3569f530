//! Where a function of one variable is least.

/// The place between two others where a function that falls and then rises is least, to (2/3)^`steps` of their distance. Each step
/// asks the function twice.
pub(crate) fn least_between(at: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2], steps: usize) -> f64 {
    for _ in 0..steps {
        let third = (high - low) / 3.0;
        if at(low + third) < at(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    0.5 * (low + high)
}
