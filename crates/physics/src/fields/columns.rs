//! The fields of a formulation, described once, and its state as columns.
//!
//! A state is one flat slice for integrators and checkpoints: the column of each evolved and kept
//! field, one after another in the order of the table, then the tail with the ledger.

use std::ops::Range;

use bytemuck::Pod;

use super::{FieldDescription, FieldKind, Life};

/// Declares the fields of a formulation, one entry each in the order in which they are shown:
///
/// ```text
/// columns! {
///     pub(super) struct Columns, ColumnsMut, enum Made;
///     evolved velocity: Vector, "m/s", "velocity v";
///     kept acceleration: Vector, "m/s2", "acceleration for the next kick";
///     derived(1) stress: Tensor, "Pa", "Cauchy stress";
///     constant volume: Scalar, "m3", "quadrature volume";
/// }
/// ```
///
/// The structs are views of the columns of a state; the enum has the fields that are not in it, which
/// the formulation makes, so that one that is not made does not compile. `FIELDS` of the enum is the
/// table. The number of a derived field says how many stages of observation it needs.
macro_rules! columns {
    ($vis:vis struct $View:ident, $Mut:ident, enum $Made:ident; $($all:tt)*) => {
        $crate::fields::columns!(@table $vis $Made; $($all)*);
        $crate::fields::columns!(@views $vis $View $Mut; $($all)*);
    };
    ($vis:vis enum $Made:ident; $($all:tt)*) => {
        $crate::fields::columns!(@table $vis $Made; $($all)*);
    };
    (@type Scalar) => { f64 };
    (@type Vector) => { $crate::Vector<D> };
    (@type Tensor) => { $crate::Tensor<D> };
    (@type Symmetric) => { [f64; 6] };
    (@describe $name:ident $kind:ident $life:expr, $unit:literal, $meaning:literal) => {
        $crate::fields::FieldDescription {
            life: $life,
            ..$crate::fields::FieldDescription::new(
                stringify!($name), $unit, $crate::fields::FieldKind::$kind, $meaning,
            )
        }
    };
    (@none $name:ident) => { None };
    (@table $vis:vis $Made:ident; $(
        $(evolved $e:ident: $ek:ident)? $(kept $k:ident: $kk:ident)?
        $(derived($stages:literal) $d:ident: $dk:ident)? $(constant $c:ident: $ck:ident)?,
        $unit:literal, $meaning:literal;
    )*) => {
        /// The fields that the formulation makes.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[expect(non_camel_case_types, reason = "the names are those of the fields")]
        $vis enum $Made { $( $( #[doc = $meaning] $d, )? $( #[doc = $meaning] $c, )? )* }

        impl $Made {
            /// All fields of the formulation.
            $vis const FIELDS: &'static [$crate::fields::FieldDescription] =
                &$crate::fields::FieldDescription::numbered([ $(
                    $( $crate::fields::columns!(
                        @describe $e $ek $crate::fields::Life::Evolved, $unit, $meaning
                    ), )?
                    $( $crate::fields::columns!(
                        @describe $k $kk $crate::fields::Life::Kept, $unit, $meaning
                    ), )?
                    $( $crate::fields::columns!(
                        @describe $d $dk $crate::fields::Life::Derived($stages), $unit, $meaning
                    ), )?
                    $( $crate::fields::columns!(
                        @describe $c $ck $crate::fields::Life::Constant, $unit, $meaning
                    ), )?
                )* ]);

            /// Which of them a field is, unless it is in the state.
            $vis fn of(field: &$crate::fields::FieldDescription) -> Option<Self> {
                const ALL: &[Option<$Made>] = &[ $(
                    $( $crate::fields::columns!(@none $e), )? $( $crate::fields::columns!(@none $k), )?
                    $( Some($Made::$d), )? $( Some($Made::$c), )?
                )* ];
                ALL.get(field.number).copied().flatten()
            }
        }
    };
    (@views $vis:vis $View:ident $Mut:ident; $(
        $(evolved $e:ident: $ek:ident)? $(kept $k:ident: $kk:ident)?
        $(derived($stages:literal) $d:ident: $dk:ident)? $(constant $c:ident: $ck:ident)?,
        $unit:literal, $meaning:literal;
    )*) => {
        /// The columns of a state.
        #[derive(Clone, Copy)]
        $vis struct $View<'a, const D: usize> { $(
            $( #[doc = $meaning] pub $e: &'a [$crate::fields::columns!(@type $ek)], )?
            $( #[doc = $meaning] pub $k: &'a [$crate::fields::columns!(@type $kk)], )?
            )*
            /// What stands behind them.
            #[allow(dead_code, reason = "where nothing does but the ledger nobody asks")]
            pub tail: &'a [f64],
        }

        impl<'a, const D: usize> $View<'a, D> {
            /// Those of a state of `count` particles.
            #[inline]
            $vis fn of(state: &'a [f64], count: usize) -> Self {
                let mut rest = state;
                Self { $(
                    $( $e: $crate::fields::take_column(&mut rest, count), )?
                    $( $k: $crate::fields::take_column(&mut rest, count), )?
                    )*
                    tail: rest,
                }
            }
        }

        /// The columns of a state or of its rates, to be changed.
        $vis struct $Mut<'a, const D: usize> { $(
            $( #[doc = $meaning] pub $e: &'a mut [$crate::fields::columns!(@type $ek)], )?
            $( #[doc = $meaning] pub $k: &'a mut [$crate::fields::columns!(@type $kk)], )?
        )* }

        impl<'a, const D: usize> $Mut<'a, D> {
            /// Those of a state of `count` particles, and its tail.
            #[inline]
            $vis fn of(state: &'a mut [f64], count: usize) -> (Self, &'a mut [f64]) {
                let mut rest = state;
                let columns = Self { $(
                    $( $e: $crate::fields::take_column_mut(&mut rest, count), )?
                    $( $k: $crate::fields::take_column_mut(&mut rest, count), )?
                )* };
                (columns, rest)
            }
        }

        impl<const D: usize> $crate::parallel::Parts for $Mut<'_, D> {
            fn split(self, middle: usize) -> (Self, Self) {
                $( $( let $e = self.$e.split_at_mut(middle); )? )*
                $( $( let $k = self.$k.split_at_mut(middle); )? )*
                (
                    Self { $( $( $e: $e.0, )? $( $k: $k.0, )? )* },
                    Self { $( $( $e: $e.1, )? $( $k: $k.1, )? )* },
                )
            }
        }
    };
}
pub(crate) use columns;

/// Takes the column of `count` particles that `rest` begins with.
#[inline]
pub(crate) fn take_column<'a, T: Pod>(rest: &mut &'a [f64], count: usize) -> &'a [T] {
    let (column, others) = rest.split_at(count * size_of::<T>() / size_of::<f64>());
    *rest = others;
    bytemuck::cast_slice(column)
}

/// As [`take_column`], to be changed.
#[inline]
pub(crate) fn take_column_mut<'a, T: Pod>(rest: &mut &'a mut [f64], count: usize) -> &'a mut [T] {
    let all = std::mem::take(rest);
    let (column, others) = all.split_at_mut(count * size_of::<T>() / size_of::<f64>());
    *rest = others;
    bytemuck::cast_slice_mut(column)
}

/// Numbers of a state a particle.
pub fn width(fields: &[FieldDescription], dimension: usize) -> usize {
    let stored = fields.iter().filter(|field| field.is_stored());
    stored.map(|field| field.kind.components(dimension)).sum()
}

/// Where the column of a field stands in a state of `count` particles; empty if it is not in it.
/// Tensors stand there column by column.
pub fn column(
    fields: &[FieldDescription],
    dimension: usize,
    count: usize,
    field: &FieldDescription,
) -> Range<usize> {
    let start = count * width(&fields[..field.number.min(fields.len())], dimension);
    let own = if field.is_stored() { field.kind.components(dimension) } else { 0 };
    start..start + count * own
}

impl FieldDescription {
    /// How many stages of observation make it.
    pub fn stages(&self) -> usize {
        if let Life::Derived(stages) = self.life { stages } else { 0 }
    }

    /// Whether it is a column of the state.
    pub fn is_stored(&self) -> bool {
        matches!(self.life, Life::Evolved | Life::Kept)
    }

    /// Appends the components of some particles out of its column, tensors row by row.
    pub fn read(&self, column: &[f64], dimension: usize, particles: &[u32], values: &mut Vec<f64>) {
        let components = self.kind.components(dimension);
        for &particle in particles {
            let own = &column[particle as usize * components..][..components];
            match self.kind {
                FieldKind::Tensor => values.extend(
                    (0..components).map(|k| own[k % dimension * dimension + k / dimension]),
                ),
                _ => values.extend_from_slice(own),
            }
        }
    }
}
