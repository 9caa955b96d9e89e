//! Whether a run fits into the memory of a device.

use piola_device::{Device, DeviceError, Machine};

use super::DeviceRefusal;

fn gibibytes(bytes: usize) -> String {
    format!("{:.2} GiB", bytes as f64 / f64::from(1 << 30))
}

/// What columns with these bytes take, and the five largest of them, if that is more than a memory has.
fn too_much(mut columns: Vec<(&str, usize)>, memory: u64) -> Option<[String; 2]> {
    let needed: usize = columns.iter().map(|(_, bytes)| bytes).sum();
    if needed as u64 <= memory {
        return None;
    }
    columns.sort_by_key(|(_, bytes)| std::cmp::Reverse(*bytes));
    let named = |(name, bytes): &(&str, usize)| format!("{name} {}", gibibytes(*bytes));
    let largest: Vec<String> = columns.iter().take(5).map(named).collect();
    Some([gibibytes(needed), largest.join(", ")])
}

/// Refuses a device whose memory does not suffice for columns with these bytes in double precision, of which those of some
/// names take half, with what takes it.
///
/// # Errors
/// [`DeviceRefusal::Memory`].
pub(crate) fn fits<'a>(
    device: &Device,
    narrow: &[&str],
    columns: impl Iterator<Item = (&'a str, usize)>,
) -> Result<(), DeviceRefusal> {
    let taken = |(name, bytes)| (name, if narrow.contains(&name) { bytes / 2 } else { bytes });
    match too_much(columns.map(taken).collect(), device.memory()) {
        None => Ok(()),
        Some([needed, largest]) => {
            let device = device.found().to_string();
            Err(DeviceRefusal::Memory { needed, device, largest })
        }
    }
}

/// Columns of a run beside its state.
#[derive(Debug, Default)]
pub(crate) struct Room {
    /// Columns of work with their lengths.
    pub scratch: Vec<(&'static str, usize)>,
    /// Columns that do not change, with their numbers.
    pub filled: Vec<(&'static str, Vec<f64>)>,
}

impl Room {
    /// Bytes that they take in double precision.
    pub fn bytes(&self) -> impl Iterator<Item = (&'static str, usize)> {
        let scratch = self.scratch.iter().map(|(name, length)| (*name, length * size_of::<f64>()));
        scratch.chain(self.filled.iter().map(|(name, numbers)| (*name, size_of_val(&**numbers))))
    }

    /// Makes them.
    pub fn make(&self, machine: &mut Machine) -> Result<(), DeviceError> {
        self.scratch.iter().try_for_each(|(name, length)| machine.add_zeros(name, *length))?;
        self.filled.iter().try_for_each(|(name, numbers)| machine.add(name, numbers))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_told_by_its_largest_columns() {
        let gibibyte = 1 << 30;
        let columns = || vec![("side", gibibyte), ("terms", 3 * gibibyte), ("rate", gibibyte / 2)];
        assert_eq!(too_much(columns(), 9 << 29), None, "it fits exactly");
        let told = ["4.50 GiB", "terms 3.00 GiB, side 1.00 GiB, rate 0.50 GiB"].map(str::to_owned);
        assert_eq!(too_much(columns(), (9 << 29) - 1), Some(told));
    }
}
