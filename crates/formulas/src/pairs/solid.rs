//! Pair laws of solids in the transport-velocity formulation. Paper: CTVF, sections 3.2 and 4.4 to 4.7.

use super::fluid::{FluidSide, Side};
use super::{
    Components, Many, MovingPair, Of, One, PairLaw, Record, Square, add_moment, difference, dot,
    record, symmetric,
};
use crate::kernels::Needs;
use crate::{Number, fluid, tensor};

/// Numbers of a particle of a solid beside density, pressure and velocity: the deviatoric stress in Pa
/// as xx, yy, zz, yz, xz, xy, the plastic strain, the temperature in K and the specific internal energy
/// in J/kg.
pub const MATTER: usize = 9;
const ZZ: usize = 2;
const YZ: usize = 3;
const XZ: usize = 4;
const PLASTIC: usize = 6;

record! {
    /// What forces gather of a particle of a solid beside its side.
    pub struct Tension<D> in SolidTension {
        /// `sigma / rho^2`, with corrected gradients `sigma L`.
        pub tensor: Square<D>,
        /// What neighbours weigh it with: the mass in kg, with corrected gradients the volume.
        pub weight: One,
        /// What makes an acceleration of the particle's own sum: 1, with corrected gradients `1 / rho`.
        pub share: One,
        /// Bulk wave speed at rest in m/s.
        pub wave_speed: One,
        /// Bulk modulus at rest in Pa.
        pub stiffness: One,
    }
}

impl<T: Number, const D: usize> Tension<T, D> {
    /// Sets what follows from the stress in Pa of a particle and, with corrected gradients, from its
    /// [`correction`]. Of what has been removed, and has no density, there is no share.
    #[inline(always)]
    pub fn set(
        &mut self,
        stress: &Of<Square<D>, T>,
        side: &Side<T, D>,
        correction: Option<&Of<Square<D>, T>>,
    ) {
        (self.tensor, self.weight, self.share) = match correction {
            Some(correction) => {
                let is_there = side.density.abs().above(0.0);
                let share = T::select(is_there, side.density.recip(), T::zero());
                (stress * *correction, side.volume, share)
            }
            None => (stress / (side.density * side.density), side.mass(), T::one()),
        };
    }
}

/// What a law is made for: bodies that see each other as one, or one alone;
pub const ONE: u8 = 0;
/// bodies that push each other by their pressures;
pub const PUSH: u8 = 1;
/// or by springs.
pub const SPRINGS: u8 = 2;

/// A side of a solid with its stress, and 1 where it is of the continuum of the particle in the middle
/// or of a wall, 0 otherwise.
type StressedSide<const D: usize> = ((FluidSide<D>, SolidTension<D>), One);

/// The constants of [`Forces`].
#[derive(Clone, Copy, Debug)]
pub struct ForceConstants {
    /// `0.01 h^2` in m^2.
    pub softening: f64,
    /// `alpha h` of CTVF (28) in m.
    pub artificial: f64,
    /// What of it there is between bodies.
    pub artificial_apart: f64,
    /// Stiffness of the springs between bodies in units of their bulk moduli.
    pub penalty: f64,
    /// How long these springs are in m.
    pub spacing: f64,
    /// `1 / W(dx)` where particles are shifted by SPST, in m^D.
    pub crowding: f64,
}

/// The accelerations of solids, theory (73) to (75). What is `PLAIN` has no corrections of gradients, and
/// waves are as fast everywhere; `CONTACT` is one of [`ONE`], [`PUSH`] and [`SPRINGS`].
#[derive(Clone, Copy, Debug)]
pub struct Forces<const D: usize, const PLAIN: bool, const CONTACT: u8>(pub ForceConstants);

record! {
    /// What [`Forces`] sums.
    pub struct ForceSums<D> in ForceSum {
        /// `sum m_b (sigma_a / rho_a^2 + sigma_b / rho_b^2) . grad W_ab`.
        pub stress: Components<D>,
        /// Acceleration by other bodies, or the force of springs in N.
        pub contact: Components<D>,
        /// Artificial viscosity.
        pub artificial: Components<D>,
        /// The stress of walls.
        pub walls: Components<D>,
        /// `sum V_b grad W_ab` in 1/m.
        pub volume: Components<D>,
        /// The same with what CTVF (35) weighs crowds with.
        pub crowding: Components<D>,
    }
}

impl<T: Number, const D: usize> ForceSums<T, D> {
    /// The accelerations in m/s^2 of a particle of a mass in kg by stress and contact, and by walls, with its
    /// [`Tension::share`].
    #[inline(always)]
    pub fn accelerations(
        &self,
        share: T,
        mass: T,
        constants: &ForceConstants,
    ) -> [Of<Components<D>, T>; 2] {
        let contact = if constants.penalty > 0.0 { mass.recip() } else { T::one() };
        [self.stress * share + self.contact * contact, self.walls * share]
    }
}

/// `m_b (sigma_a/rho_a^2 + sigma_b/rho_b^2) . grad W_ab`, with corrected gradients
/// `V_b (sigma_a L_a + sigma_b L_b) . grad W_ab`.
///
/// What is `PLAIN` has no corrections and is symmetric: each number less to collect from neighbours
/// counts.
#[inline(always)]
fn pull<T: Number, const D: usize, const PLAIN: bool>(
    me: &Tension<T, D>,
    (side, tension): &Of<(FluidSide<D>, SolidTension<D>), T>,
    pair: &Of<MovingPair<D>, T>,
) -> Of<Components<D>, T> {
    let weight = if PLAIN { side.mass() } else { tension.weight };
    let slope = weight * pair.slope;
    let mut force = Components::<D>::zero();
    for i in 0..D {
        let mut sum = T::zero();
        for j in 0..D {
            let at = if PLAIN { (i.min(j), i.max(j)) } else { (i, j) };
            sum += (me.tensor[at] + tension.tensor[at]) * pair.separation[j];
        }
        force[i] = sum * slope;
    }
    force
}

impl<const D: usize, const PLAIN: bool, const CONTACT: u8> Forces<D, PLAIN, CONTACT> {
    /// What shifting and surfaces need.
    #[inline(always)]
    fn crowd<T: Number>(&self, volume: T, pair: &Of<MovingPair<D>, T>, sums: &mut ForceSums<T, D>) {
        let factor = fluid::repulsion(pair.value * self.0.crowding);
        let slope = volume * pair.slope;
        for i in 0..D {
            let area = pair.separation[i] * slope;
            sums.volume[i] += area;
            sums.crowding[i] += area * factor;
        }
    }

    /// What bodies that are apart do to each other, over the separation.
    #[inline(always)]
    fn touch<T: Number>(
        &self,
        (me, mine): &Of<(FluidSide<D>, SolidTension<D>), T>,
        (other, theirs): &Of<(FluidSide<D>, SolidTension<D>), T>,
        pair: &Of<MovingPair<D>, T>,
    ) -> T {
        if CONTACT == SPRINGS {
            let (one, two) = (mine.stiffness, theirs.stiffness);
            let distance = pair.square.sqrt();
            let overlap = positive(T::from(self.0.spacing) - distance);
            let spring = one * 2.0 * two / (one + two) * self.0.penalty * overlap;
            let least = f64::MIN_POSITIVE;
            spring / T::select(distance.above(least), distance, T::from(least))
        } else {
            -positive(me.load + other.load) * other.mass() * pair.slope
        }
    }
}

/// The number, or zero where it is negative.
#[inline(always)]
fn positive<T: Number>(number: T) -> T {
    T::select(number.above(0.0), number, T::zero())
}

impl<const D: usize, const PLAIN: bool, const CONTACT: u8> PairLaw for Forces<D, PLAIN, CONTACT> {
    type Pair = MovingPair<D>;
    type Side = StressedSide<D>;
    type Sums = ForceSum<D>;

    const NEEDS: Needs = Needs::Both;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        (me, _): &Of<Self::Side, T>,
        (other, own): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut ForceSums<T, D>,
    ) {
        let own = *own;
        let ((side, mine), (other_side, theirs)) = (me, other);
        let force = pull::<T, D, PLAIN>(mine, other, pair);
        for i in 0..D {
            sums.stress[i] += force[i] * own;
        }
        // The artificial viscosity, CTVF (28), which pushes.
        let jump = difference(&side.velocity, &other_side.velocity);
        let approach = dot(&jump, &pair.separation);
        let densities = side.density + other_side.density;
        let scale = fluid::exchange_scale(densities, pair.square, self.0.softening);
        let alpha = own * self.0.artificial + (T::one() - own) * self.0.artificial_apart;
        let speed = match PLAIN {
            true => mine.wave_speed,
            false => (mine.wave_speed + theirs.wave_speed) * 0.5,
        };
        let artificial = fluid::artificial_viscosity(alpha * speed, approach, scale);
        let push = artificial * other_side.mass() * pair.slope;
        for i in 0..D {
            sums.artificial[i] -= pair.separation[i] * push;
        }
        if CONTACT != ONE {
            let push = self.touch(me, other, pair) * (T::one() - own);
            for i in 0..D {
                sums.contact[i] += pair.separation[i] * push;
            }
        }
        self.crowd(other_side.volume * own, pair, sums);
    }
}

/// What walls do to solids, in the sums of their [`Forces`].
#[derive(Clone, Copy, Debug)]
pub struct WallForces<L>(pub L);

impl<const D: usize, const PLAIN: bool, const CONTACT: u8> PairLaw
    for WallForces<Forces<D, PLAIN, CONTACT>>
{
    type Pair = MovingPair<D>;
    type Side = StressedSide<D>;
    type Sums = ForceSum<D>;

    const NEEDS: Needs = Needs::Both;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        ((_, me), _): &Of<Self::Side, T>,
        (other, _): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut ForceSums<T, D>,
    ) {
        let force = pull::<T, D, PLAIN>(me, other, pair);
        for i in 0..D {
            sums.walls[i] += force[i];
        }
        self.0.crowd(other.0.volume, pair, sums);
    }
}

/// The force of solids on a wall particle, to be multiplied by its [`Tension::share`], in m/s^2.
#[derive(Clone, Copy, Debug)]
pub struct Wall<const D: usize>;

impl<const D: usize> PairLaw for Wall<D> {
    type Pair = MovingPair<D>;
    type Side = (FluidSide<D>, SolidTension<D>);
    type Sums = Components<D>;

    const NEEDS: Needs = Needs::Slope;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        (_, me): &Of<Self::Side, T>,
        other: &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sum: &mut Of<Components<D>, T>,
    ) {
        let force = pull::<T, D, false>(me, other, pair);
        for i in 0..D {
            sum[i] += force[i];
        }
    }
}

/// What rates are made for: one elastic body whose pressure follows its density,
pub const ALONE: u8 = 0;
/// several of them,
pub const ELASTIC: u8 = 1;
/// or any solids, with what flows, heats and diffuses.
pub const ANY: u8 = 2;

/// Whether a law of a `kind` carries an entry of the material state: in 1D and 2D there is no shear
/// across, what is elastic carries nothing but its stress, and zz is what makes the trace of that zero.
pub const fn is_carried(dimension: usize, kind: u8, entry: usize) -> bool {
    match entry {
        PLASTIC.. => kind == ANY,
        ZZ => false,
        YZ | XZ => dimension == 3,
        _ => true,
    }
}

/// The constants of [`Rates`].
#[derive(Clone, Copy, Debug)]
pub struct RateConstants {
    /// `0.01 h^2` in m^2.
    pub softening: f64,
    /// `alpha h` of CTVF (28) in m.
    pub artificial: f64,
    /// `alpha h / 8` of CTVF (24) in m, to be multiplied by a wave speed.
    pub diffusion: f64,
    /// 1 where gradients are those of the transport velocity.
    pub moves: f64,
}

/// Velocity gradients of solids and what the transport velocity carries, CTVF (31), theory (68), (75):
/// `KIND` is one of [`ALONE`], [`ELASTIC`] and [`ANY`]; `CARRIES` says whether the deviation carries
/// anything.
#[derive(Clone, Copy, Debug)]
pub struct Rates<const D: usize, const KIND: u8, const CARRIES: bool>(pub RateConstants);

record! {
    /// What [`Rates`] sums.
    pub struct RateSums<D> in RateSum {
        /// `d u_i / d x_j` in 1/s.
        pub gradient: Square<D>,
        /// The divergence by other bodies in 1/s.
        pub contact: One,
        /// `d . grad rho` in kg/(m^3 s).
        pub density: One,
        /// `d . grad p` in Pa/s.
        pub pressure: One,
        /// Diffusion of the pressure in Pa/s.
        pub diffusion: One,
        /// Heat of the artificial viscosity in W/kg.
        pub heating: One,
        /// `d . grad` of the material state.
        pub carried: Many<MATTER>,
    }
}

impl<const D: usize, const KIND: u8, const CARRIES: bool> Rates<D, KIND, CARRIES> {
    /// What the deviation carries of the material state in a second, theory (68): of the sums of the law, and
    /// what makes the trace of the stress zero.
    #[inline]
    pub fn transport<T: Number>(sums: &RateSums<T, D>) -> [T; MATTER] {
        let mut transport = sums.carried;
        for (k, transport) in transport.iter_mut().enumerate() {
            if !(CARRIES && is_carried(D, KIND, k)) {
                *transport = T::zero();
            }
        }
        transport[ZZ] = -transport[0] - transport[1];
        transport
    }
}

impl<const D: usize, const KIND: u8, const CARRIES: bool> PairLaw for Rates<D, KIND, CARRIES> {
    type Pair = MovingPair<D>;
    type Side = ((FluidSide<D>, SolidTension<D>), (Many<MATTER>, One));
    type Sums = RateSum<D>;

    const NEEDS: Needs = Needs::Slope;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        ((me, mine), (matter, _)): &Of<Self::Side, T>,
        ((side, tension), (other_matter, own)): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut RateSums<T, D>,
    ) {
        let area = side.volume * pair.slope;
        let within = area * *own;
        let jump = difference(&me.velocity, &side.velocity);
        let apart = difference(&me.deviation, &side.deviation);
        let mut flow = jump;
        for i in 0..D {
            flow[i] += apart[i] * self.0.moves;
        }
        for i in 0..D {
            for j in 0..D {
                sums.gradient[(i, j)] -= flow[i] * pair.separation[j] * within;
            }
        }
        if KIND != ALONE {
            let opening = -dot(&flow, &pair.separation) * (area - within);
            // Where forces are cut, (75), parting does nothing either: it would make energy.
            let closing = T::select(opening.below(0.0), opening, T::zero());
            sums.contact += T::select((me.load + side.load).below(0.0), closing, opening);
        }
        if KIND == ANY {
            let approach = dot(&jump, &pair.separation);
            let speed = (mine.wave_speed + tension.wave_speed) * 0.5;
            let densities = me.density + side.density;
            let scale = fluid::exchange_scale(densities, pair.square, self.0.softening);
            let slope = side.mass() * pair.slope;
            let artificial =
                fluid::artificial_viscosity(speed * self.0.artificial, approach, scale);
            sums.heating += artificial * 0.5 * approach * slope;
            let diffusivity = speed * self.0.diffusion * *own;
            let exchange = fluid::diffusion(1.0, pair.square, slope, scale) * diffusivity;
            sums.diffusion -= exchange * (side.pressure - me.pressure);
        }
        if CARRIES {
            let carried = dot(&side.deviation, &pair.separation) * within;
            sums.density += carried * (side.density - me.density);
            if KIND == ANY {
                sums.pressure += carried * (side.pressure - me.pressure);
            }
            for k in 0..MATTER {
                if is_carried(D, KIND, k) {
                    sums.carried[k] += carried * (other_matter[k] - matter[k]);
                }
            }
        }
    }
}

/// `sum V_b (r_b - r_a) (x) grad W_ab` over the own continuum, of which the entries with `i <= j` are
/// filled: the inverse corrects gradients, theory (74).
#[derive(Clone, Copy, Debug)]
pub struct Moments<const D: usize>;

impl<const D: usize> PairLaw for Moments<D> {
    type Pair = MovingPair<D>;
    type Side = (FluidSide<D>, One);
    type Sums = Square<D>;

    const NEEDS: Needs = Needs::Slope;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        _me: &Of<Self::Side, T>,
        (other, own): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut Of<Square<D>, T>,
    ) {
        add_moment(pair, *own * other.volume * pair.slope, sums);
    }
}

/// Smallest eigenvalue of the matrix to be inverted that is trusted. At an edge of a body it is a
/// half, in a corner a quarter; a particle that has lost its neighbours gets no correction.
const LEAST: f64 = 0.1;

/// The correction `L_a = [ sum V_b (r_b - r_a) (x) grad W_ab ]^-1` of theory (74) with the sums of [`Moments`], of
/// which those with `i <= j` are filled; the identity where it cannot be trusted.
#[inline]
pub fn correction<T: Number, const D: usize>(sums: &Of<Square<D>, T>) -> Of<Square<D>, T> {
    let sum = symmetric(sums);
    let determinant = tensor::determinant(&sum);
    let inverse = tensor::cofactor(&sum).transpose() / determinant;
    let is_finite = |number: &T| number.abs().at_most(T::from(f64::MAX));
    let trusted = tensor::smallest_eigenvalue(&sum).above(LEAST) & is_finite(&determinant);
    let trusted = inverse.iter().fold(trusted, |all, entry| all & is_finite(entry));
    Of::<Square<D>, T>::from_fn(|i, j| {
        let unit = if i == j { T::one() } else { T::zero() };
        T::select(trusted, inverse[(i, j)], unit)
    })
}
