//! One number out of a field's components.

use super::{ABSENT, FieldDescription, FieldKind, is_absent};

/// A field or one component of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldSelector {
    /// The field.
    pub field: FieldDescription,
    /// What of it.
    pub component: Component,
}

impl FieldSelector {
    /// The selected number out of the components of one particle, laid out as in
    /// [`FieldValues`](super::FieldValues). Not a number if there are too few components,
    /// or if the whole of a vector or tensor is selected.
    pub fn value(&self, components: &[f64]) -> f64 {
        if components.first().is_some_and(|value| is_absent(*value)) {
            return ABSENT;
        }
        match (self.component, self.field.kind) {
            (Component::Whole, FieldKind::Scalar) => components.first().copied(),
            (Component::Whole, _) => None,
            (Component::Entry(number), _) => components.get(number).copied(),
            (Component::Magnitude, _) => {
                Some(components.iter().map(|value| value * value).sum::<f64>().sqrt())
            }
        }
        .unwrap_or(f64::NAN)
    }

    /// As a case file writes it: `velocity.x`, `velocity.magnitude`, `deformation_gradient.xy`.
    pub fn name(&self, dimension: usize) -> String {
        match self.component {
            Component::Whole => self.field.name.to_owned(),
            Component::Magnitude => format!("{}.magnitude", self.field.name),
            Component::Entry(number) => {
                format!(
                    "{}.{}",
                    self.field.name,
                    component_name(self.field.kind, number, dimension)
                )
            }
        }
    }
}

/// The name of component `number` of a field in `dimension` dimensions: `x`, or `xy` of a tensor.
pub fn component_name(kind: FieldKind, number: usize, dimension: usize) -> String {
    const AXES: [&str; 3] = ["x", "y", "z"];
    match kind {
        FieldKind::Scalar => String::new(),
        FieldKind::Vector => AXES[number.min(2)].to_owned(),
        FieldKind::Tensor => {
            let row = number / dimension.max(1);
            let column = number % dimension.max(1);
            format!("{}{}", AXES[row.min(2)], AXES[column.min(2)])
        }
        FieldKind::Symmetric => ["xx", "yy", "zz", "yz", "xz", "xy"][number.min(5)].to_owned(),
    }
}

/// What of a field is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    /// The field itself: the number of a scalar, all components of a vector or tensor.
    Whole,
    /// One component, counted as in [`FieldValues`](super::FieldValues).
    Entry(usize),
    /// The Euclidean or Frobenius norm.
    Magnitude,
}
