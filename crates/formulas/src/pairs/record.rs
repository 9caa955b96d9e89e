//! Structs of numbers of any type.

use std::fmt::Debug;
use std::marker::PhantomData;

use nalgebra::{SMatrix, SVector};

use crate::Number;

/// A family of structs, one for each number type: what a particle shows, what is summed.
///
/// [`Record::map`] leads from one number type to another: four records of plain numbers make one of
/// lanes, one makes one of lanes that are all the same.
pub trait Record: Send + Sync + 'static {
    /// The struct of numbers `T`.
    type Of<T: Number>: Copy + Debug;

    /// How many numbers it has.
    const NUMBERS: usize;

    /// All numbers zero.
    fn zero<T: Number>() -> Self::Of<T>;

    /// The struct whose numbers are `f` of the same numbers of all of `from`.
    fn map<S: Number, T: Number, const N: usize>(
        from: [&Self::Of<S>; N],
        f: &impl Fn([S; N]) -> T,
    ) -> Self::Of<T>;

    /// Appends the names of its numbers in the order of [`Record::map`], each after `prefix`.
    fn names(prefix: &str, names: &mut Vec<String>);
}

/// A name within another.
pub(crate) fn within(prefix: &str, name: &str) -> String {
    if prefix.is_empty() { name.into() } else { format!("{prefix}_{name}") }
}

/// Names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// What is picked of each of some records.
///
/// A loop, because the methods of arrays that take functions stay calls in loops over neighbours, and one
/// without a range, as this stands in every law and every line of it is compiled thousands of times.
#[inline(always)]
pub(crate) fn each<'a, S, T: Copy, const N: usize>(
    from: [&'a S; N],
    pick: impl Fn(&'a S) -> T,
) -> [T; N] {
    let mut picked = [pick(from[0]); N];
    let mut k = 1;
    while k < N {
        picked[k] = pick(from[k]);
        k += 1;
    }
    picked
}

/// The struct of a family for numbers `T`.
pub type Of<R, T> = <R as Record>::Of<T>;

/// One number.
#[derive(Clone, Copy, Debug)]
pub struct One;

impl Record for One {
    type Of<T: Number> = T;

    const NUMBERS: usize = 1;

    #[inline(always)]
    fn zero<T: Number>() -> T {
        T::zero()
    }

    #[inline(always)]
    fn map<S: Number, T: Number, const N: usize>(from: [&S; N], f: &impl Fn([S; N]) -> T) -> T {
        f(each(from, |part| *part))
    }

    fn names(prefix: &str, names: &mut Vec<String>) {
        names.push(prefix.into());
    }
}

/// `N` of the same kind.
#[derive(Clone, Copy, Debug)]
pub struct Each<R, const N: usize>(PhantomData<R>);

/// `N` numbers.
pub type Many<const N: usize> = Each<One, N>;

impl<R: Record, const M: usize> Record for Each<R, M> {
    type Of<T: Number> = [R::Of<T>; M];

    const NUMBERS: usize = M * R::NUMBERS;

    #[inline(always)]
    fn zero<T: Number>() -> Self::Of<T> {
        [R::zero(); M]
    }

    #[inline(always)]
    fn map<S: Number, T: Number, const N: usize>(
        from: [&Self::Of<S>; N],
        f: &impl Fn([S; N]) -> T,
    ) -> Self::Of<T> {
        let mut all = Self::zero();
        for (i, own) in all.iter_mut().enumerate() {
            *own = R::map(each(from, |part| &part[i]), f);
        }
        all
    }

    fn names(prefix: &str, names: &mut Vec<String>) {
        (0..M).for_each(|i| R::names(&within(prefix, &i.to_string()), names));
    }
}

/// A vector of `D` components.
#[derive(Clone, Copy, Debug)]
pub struct Components<const D: usize>;

impl<const D: usize> Record for Components<D> {
    type Of<T: Number> = SVector<T, D>;

    const NUMBERS: usize = D;

    #[inline(always)]
    fn zero<T: Number>() -> SVector<T, D> {
        SVector::from_array_storage(nalgebra::ArrayStorage([[T::zero(); D]; 1]))
    }

    #[inline(always)]
    fn map<S: Number, T: Number, const N: usize>(
        from: [&SVector<S, D>; N],
        f: &impl Fn([S; N]) -> T,
    ) -> SVector<T, D> {
        let mut vector = Self::zero();
        for i in 0..D {
            vector[i] = f(each(from, |part| part[i]));
        }
        vector
    }

    fn names(prefix: &str, names: &mut Vec<String>) {
        names.extend(AXES[..D].iter().map(|axis| within(prefix, axis)));
    }
}

/// A tensor of `D * D` components.
#[derive(Clone, Copy, Debug)]
pub struct Square<const D: usize>;

impl<const D: usize> Record for Square<D> {
    type Of<T: Number> = SMatrix<T, D, D>;

    const NUMBERS: usize = D * D;

    #[inline(always)]
    fn zero<T: Number>() -> SMatrix<T, D, D> {
        SMatrix::from_array_storage(nalgebra::ArrayStorage([[T::zero(); D]; D]))
    }

    #[inline(always)]
    fn map<S: Number, T: Number, const N: usize>(
        from: [&SMatrix<S, D, D>; N],
        f: &impl Fn([S; N]) -> T,
    ) -> SMatrix<T, D, D> {
        let mut tensor = Self::zero();
        for i in 0..D {
            for j in 0..D {
                tensor[(i, j)] = f(each(from, |part| part[(i, j)]));
            }
        }
        tensor
    }

    fn names(prefix: &str, names: &mut Vec<String>) {
        let axes = &AXES[..D];
        let entries = axes.iter().flat_map(|i| axes.iter().map(move |j| format!("{i}{j}")));
        names.extend(entries.map(|entry| within(prefix, &entry)));
    }
}

impl<A: Record, B: Record> Record for (A, B) {
    type Of<T: Number> = (A::Of<T>, B::Of<T>);

    const NUMBERS: usize = A::NUMBERS + B::NUMBERS;

    #[inline(always)]
    fn zero<T: Number>() -> Self::Of<T> {
        (A::zero(), B::zero())
    }

    #[inline(always)]
    fn map<S: Number, T: Number, const N: usize>(
        from: [&Self::Of<S>; N],
        f: &impl Fn([S; N]) -> T,
    ) -> Self::Of<T> {
        (A::map(each(from, |part| &part.0), f), B::map(each(from, |part| &part.1), f))
    }

    fn names(prefix: &str, names: &mut Vec<String>) {
        A::names(prefix, names);
        B::names(&within(prefix, "beside"), names);
    }
}

/// Declares a struct of numbers and its family: `pub struct NAME<D> in FAMILY { FIELD: RECORD, ... }`.
macro_rules! record {
    (
        $(#[$meta:meta])*
        pub struct $name:ident<$D:ident> in $family:ident {
            $($(#[$field_meta:meta])* pub $field:ident: $kind:ty,)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name<T: $crate::Number, const $D: usize> {
            $($(#[$field_meta])* pub $field: $crate::pairs::Of<$kind, T>,)*
        }

        #[doc = concat!("[`", stringify!($name), "`] for every number type.")]
        #[derive(Clone, Copy, Debug)]
        pub struct $family<const $D: usize>;

        impl<const $D: usize> $crate::pairs::Record for $family<$D> {
            type Of<T: $crate::Number> = $name<T, $D>;

            const NUMBERS: usize = 0 $(+ <$kind as $crate::pairs::Record>::NUMBERS)*;

            #[inline(always)]
            fn zero<T: $crate::Number>() -> Self::Of<T> {
                $name { $($field: <$kind as $crate::pairs::Record>::zero()),* }
            }

            #[inline(always)]
            fn map<S: $crate::Number, T: $crate::Number, const N: usize>(
                from: [&Self::Of<S>; N],
                f: &impl Fn([S; N]) -> T,
            ) -> Self::Of<T> {
                $name {
                    $($field: <$kind as $crate::pairs::Record>::map(
                        $crate::pairs::record::each(from, |part| &part.$field),
                        f,
                    )),*
                }
            }

            fn names(prefix: &str, names: &mut Vec<String>) {
                $(<$kind as $crate::pairs::Record>::names(
                    &$crate::pairs::record::within(prefix, stringify!($field)),
                    names,
                );)*
            }
        }
    };
}
pub(crate) use record;
