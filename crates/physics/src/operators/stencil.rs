//! The coefficients of one particle in all sums around it.

use piola_formulas::kernels::Kernel;

use super::directed::DirectedSupport;
use super::error::OperatorError;
use super::gradient::{Correction, invert};
use super::images::Image;
use crate::geometry::Particles;
use crate::neighbors::{Domain, NeighborList};
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
    /// `s_pq/tr L_p` of theory (47), in 1/m^2, of a gradient that is corrected.
    pub weight: f64,
}

/// The sums around one particle.
#[derive(Clone, Debug)]
pub(super) struct Stencil<const D: usize> {
    pub entries: Vec<Entry<D>>,
    /// `w_p W_pp`.
    pub own: f64,
    /// Coefficient of the particle itself in the gradient of differences, 1/m.
    pub diagonal: Vector<D>,
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
    let correction = match form {
        GradientForm::Corrected => Correction::Gradient,
        _ => Correction::None,
    };
    let mut stencils = stencils_on(cover, &DirectedSupport::of(cover)?.list, correction)?;
    if form == GradientForm::Plain {
        stencils.iter_mut().for_each(|stencil| stencil.diagonal = Vector::zeros());
    }
    Ok(stencils)
}

/// The sums around all particles over the neighbours of a list of particles, and behind them of images.
///
/// # Errors
/// [`OperatorError`] for particles without a corrected gradient.
pub(super) fn stencils_on<const D: usize>(
    cover: &Cover<'_, D>,
    list: &NeighborList,
    correction: Correction,
) -> Result<Vec<Stencil<D>>, OperatorError> {
    let Cover { particles, images, kernel, radius, domain, .. } = *cover;
    parallel::try_map(particles.len(), |a| {
        let h = radius[a] / kernel.support_over_h();
        let neighbors = list.row(a).iter().map(|&b| {
            let slot = b as usize;
            let (source, position) = match slot.checked_sub(particles.len()) {
                None => (slot, particles.position[slot]),
                Some(image) => (images[image].source as usize, images[image].position),
            };
            ([slot, source], domain.separation(&particles.position[a], &position))
        });
        stencil(particles, (kernel, h), correction, a, neighbors)
    })
}

/// The sums around particle `a` over neighbours, each with its slot, the particle that it is or mirrors, and
/// where it is from `a`.
///
/// # Errors
/// [`OperatorError`] where a neighbour is at the same place, and where the correction does not exist.
pub(super) fn stencil<const D: usize>(
    particles: &Particles<D>,
    (kernel, h): (Kernel, f64),
    correction: Correction,
    a: usize,
    neighbors: impl ExactSizeIterator<Item = ([usize; 2], Vector<D>)>,
) -> Result<Stencil<D>, OperatorError> {
    let mut seen = Vec::with_capacity(neighbors.len());
    for ([neighbor, source], separation) in neighbors {
        let distance = separation.norm();
        if !(distance > 0.0) {
            return Err(OperatorError::Coincident {
                first: particles.id[a],
                second: particles.id[source],
                position: particles.position[a].iter().copied().collect(),
            });
        }
        // grad_a W_ab = W'(r)/r (X_a - X_b); the separation is X_b - X_a.
        let slope = -kernel.derivative_over_r(D, distance, h);
        let (weight, value) = (particles.weight[source], kernel.value(D, distance, h));
        seen.push(Seen {
            neighbor,
            separation,
            weight,
            slope,
            value,
            gradient: separation * slope,
        });
    }
    let own = particles.weight[a] * kernel.value(D, 0.0, h);
    if correction == Correction::KernelAndGradient {
        let sum = own + seen.iter().map(|it| it.weight * it.value).sum::<f64>();
        let slope: Vector<D> = seen.iter().map(|it| it.gradient * it.weight).sum();
        for it in &mut seen {
            it.gradient = (it.gradient * sum - slope * it.value) / (sum * sum); // Upwind (2.42)
        }
    }
    let mut trace = 1.0;
    if correction != Correction::None {
        let moments = seen.iter().map(|it| it.gradient * it.separation.transpose() * it.weight);
        let moment: Tensor<D> = moments.sum();
        let inverse = invert(particles, a, seen.len(), &moment, correction.name())?;
        trace = moment.trace();
        // Upwind (2.41) with (2.43)
        seen.iter_mut().for_each(|it| it.gradient = inverse * it.gradient);
    }
    let entry = |it: &Seen<D>| Entry {
        neighbor: it.neighbor,
        value: it.weight * it.value,
        gradient: it.gradient * it.weight,
        weight: it.weight * it.slope / trace,
    };
    let entries: Vec<Entry<D>> = seen.iter().map(entry).collect();
    let diagonal = -entries.iter().map(|entry| entry.gradient).sum::<Vector<D>>();
    Ok(Stencil { entries, own, diagonal })
}

/// What the kernel sees of a neighbour, without its weight.
struct Seen<const D: usize> {
    neighbor: usize,
    separation: Vector<D>,
    /// `w_q`.
    weight: f64,
    /// `-W'(r)/r`.
    slope: f64,
    value: f64,
    gradient: Vector<D>,
}
