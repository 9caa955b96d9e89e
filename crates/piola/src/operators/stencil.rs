//! The coefficients of one particle in all sums around it.

use piola_formulas::kernels::Kernel;

use super::error::OperatorError;
use super::gradient::invert;
use super::images::Image;
use crate::geometry::Particles;
use crate::neighbors::{Domain, NeighborList, search};
use crate::{Tensor, Vector, parallel};

/// What a kernel gradient is made into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GradientForm {
    /// `V_q dW/dx`, the matrices X, Y and Z of Elastodynamics (2.33) and (2.34), with a zero on the
    /// diagonal. Exact for nothing where supports are cut.
    Plain,
    /// The same of differences, exact for constants.
    Difference,
    /// The same with the moment matrix of theory (44), exact for linear fields.
    Corrected,
}

impl GradientForm {
    /// All forms.
    pub const ALL: [Self; 3] = [Self::Plain, Self::Difference, Self::Corrected];

    /// Name in a case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Difference => "difference",
            Self::Corrected => "corrected",
        }
    }

    /// The form of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|form| form.name() == name)
    }
}

/// Particles, their ghosts, and the kernel that sums over both.
pub struct Cover<'a, const D: usize> {
    /// The particles.
    pub particles: &'a Particles<D>,
    /// Number of the group of each particle: those of other groups are not seen. All see all if it
    /// is empty.
    pub group: &'a [u32],
    /// Their ghosts.
    pub images: &'a [Image<D>],
    /// The cover function.
    pub kernel: Kernel,
    /// Support radius of each particle in m.
    pub radius: &'a [f64],
    /// The box and its periodic axes.
    pub domain: Domain<D>,
}

/// A neighbour with its coefficients: a particle, or behind them a ghost.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<const D: usize> {
    /// Index of the particle, or the number of particles plus that of the image.
    pub neighbor: usize,
    /// `w_q W_pq`.
    pub value: f64,
    /// The coefficient of the gradient in 1/m.
    pub gradient: Vector<D>,
    /// `s_pq/tr L_p` of theory (47), in 1/m^2.
    pub weight: f64,
}

/// The sums around one particle.
#[derive(Clone, Debug)]
pub(super) struct Stencil<const D: usize> {
    pub entries: Vec<Entry<D>>,
    /// `w_p W_pp`.
    pub own: f64,
    /// Coefficient of the particle itself in the gradient, 1/m.
    pub diagonal: Vector<D>,
    /// `L_p/tr L_p`.
    pub shape: Tensor<D>,
}

/// The sums around all particles.
///
/// # Errors
/// [`OperatorError`] for positions and supports without neighbour lists, and for particles without
/// a corrected gradient.
pub(super) fn stencils<const D: usize>(
    cover: &Cover<'_, D>,
    form: GradientForm,
) -> Result<Vec<Stencil<D>>, OperatorError> {
    let count = cover.particles.len();
    let sources = cover.images.iter().map(|image| image.source as usize);
    let mut positions = cover.particles.position.clone();
    positions.extend(cover.images.iter().map(|image| image.position));
    let mut radius = cover.radius.to_vec();
    radius.extend(sources.map(|source| cover.radius[source]));
    let list = search(&positions, &radius, &cover.domain)?;
    let mut found: Vec<Result<Option<Stencil<D>>, OperatorError>> = Vec::new();
    found.resize_with(count, || Ok(None));
    parallel::for_each_chunk(&mut found, |first, rows| {
        for (offset, row) in rows.iter_mut().enumerate() {
            *row = stencil(cover, form, &positions, &list, first + offset).map(Some);
        }
    });
    let mut all = Vec::with_capacity(count);
    for row in found {
        all.extend(row?);
    }
    Ok(all)
}

fn stencil<const D: usize>(
    cover: &Cover<'_, D>,
    form: GradientForm,
    positions: &[Vector<D>],
    list: &NeighborList,
    a: usize,
) -> Result<Stencil<D>, OperatorError> {
    let Cover { particles, group, images, kernel, radius, domain } = cover;
    let count = particles.len();
    let h = radius[a] / kernel.support_over_h();
    let of_group = |b: usize| group.is_empty() || group[b] == group[a];
    let mut entries = Vec::with_capacity(list.row(a).len());
    let mut moment = Tensor::<D>::zeros();
    for &b in list.row(a) {
        let neighbor = b as usize;
        let source =
            if neighbor < count { neighbor } else { images[neighbor - count].source as usize };
        if !of_group(source) {
            continue;
        }
        let separation = domain.separation(&positions[a], &positions[neighbor]);
        let distance = separation.norm();
        if !(distance > 0.0) {
            return Err(OperatorError::Coincident {
                first: particles.id[a],
                second: particles.id[source],
                position: particles.position[a].iter().copied().collect(),
            });
        }
        let weight = -particles.weight[source] * kernel.derivative_over_r(D, distance, h);
        moment += separation * separation.transpose() * weight;
        entries.push(Entry {
            neighbor,
            value: particles.weight[source] * kernel.value(D, distance, h),
            gradient: separation * weight,
            weight,
        });
    }
    let trace = moment.trace();
    if form == GradientForm::Corrected {
        let inverse = invert(particles, a, entries.len(), &moment, "gradient")?;
        entries.iter_mut().for_each(|entry| entry.gradient = inverse * entry.gradient);
    }
    if trace > 0.0 {
        entries.iter_mut().for_each(|entry| entry.weight /= trace);
        moment /= trace;
    }
    let diagonal = match form {
        GradientForm::Plain => Vector::zeros(),
        _ => -entries.iter().map(|entry| entry.gradient).sum::<Vector<D>>(),
    };
    let own = particles.weight[a] * kernel.value(D, 0.0, h);
    Ok(Stencil { entries, own, diagonal, shape: moment })
}
