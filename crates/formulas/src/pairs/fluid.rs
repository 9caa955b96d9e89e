//! Pair laws of the weakly compressible fluid of the transport-velocity formulation. Paper: CTVF.
//!
//! `r_ab = r_a - r_b`, `u_ab = u_a - u_b`, `V = m / rho`, and d is the shifting velocity by which
//! the transport velocity differs from u.

use super::{Components, MovingPair, Of, One, PairLaw, difference, dot, record};
use crate::kernels::Needs;
use crate::{Number, fluid};

record! {
    /// A particle as its neighbours see it, in one place so that it costs one stretch of memory.
    pub struct Side<D> in FluidSide {
        /// Momentum velocity u in m/s; of a wall particle that of CTVF (48).
        pub velocity: Components<D>,
        /// Deviation d = uhat - u of the transport velocity in m/s.
        pub deviation: Components<D>,
        /// Density in kg/m^3.
        pub density: One,
        /// `m / rho` in m^D.
        pub volume: One,
        /// `p / rho^2` in Pa m^6/kg^2.
        pub load: One,
        /// Pressure in Pa.
        pub pressure: One,
    }
}

impl<T: Number, const D: usize> Side<T, D> {
    /// Mass in kg.
    #[inline(always)]
    pub fn mass(&self) -> T {
        self.volume * self.density
    }

    /// Sets density and pressure and what follows from them and the mass in kg.
    #[inline(always)]
    pub fn set(&mut self, mass: T, density: T, pressure: T) {
        self.density = density;
        self.pressure = pressure;
        self.load = pressure / (density * density);
        self.volume = mass / density;
    }
}

/// The form of viscous forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Viscous {
    /// Along the difference of velocities, `nu lap u`, theory (23): on a free surface the gradient of the velocity
    /// across it is zero.
    Laplacian,
    /// Along the line between particles, `div(nu (grad u + grad u^T))`, theory (90): on a free surface there is no stress, and
    /// angular momentum is kept.
    Stress,
}

impl Viscous {
    /// How many times the viscosity a compression along one direction meets.
    pub fn along(self) -> f64 {
        match self {
            Self::Laplacian => 1.0,
            Self::Stress => 3.0,
        }
    }

    /// The direction and the factor of the force between two particles where velocities differ by a `jump` in m/s,
    /// with the `slope` of the kernel, the sum of their densities and an [`exchange_scale`](fluid::exchange_scale).
    #[inline(always)]
    fn force<T: Number, const D: usize>(
        self,
        viscosity: f64,
        jump: &Of<Components<D>, T>,
        pair: &Of<MovingPair<D>, T>,
        [slope, densities, scale]: [T; 3],
    ) -> (Of<Components<D>, T>, T) {
        match self {
            Self::Laplacian => (*jump, fluid::viscous_drag(viscosity, slope, densities)),
            Self::Stress => {
                let approach = dot(jump, &pair.separation);
                (pair.separation, fluid::viscous_push::<T, D>(viscosity, approach, slope, scale))
            }
        }
    }
}

/// Which corrections of the momentum equation a law is made for: none,
pub const NONE: u8 = 0;
/// `(d . grad) u`,
pub const FULL: u8 = 1;
/// or the stress of CTVF (27), with the dilatation as [`ForceConstants`] has it.
pub const STRESS: u8 = 2;

/// The constants of [`Forces`].
#[derive(Clone, Copy, Debug)]
pub struct ForceConstants {
    /// `0.01 h^2` in m^2.
    pub softening: f64,
    /// Kinematic viscosity in m^2/s.
    pub viscosity: f64,
    /// Which form viscous forces have.
    pub viscous: Viscous,
    /// `alpha h c` of CTVF (28) in m^2/s.
    pub artificial: f64,
    /// 1 where `- u div uhat` of CTVF (27) is beside its stress, 0 otherwise.
    pub dilatation: f64,
    /// `1 / W(dx)` in m^D.
    pub crowding: f64,
}

/// The accelerations of a fluid, CTVF (18), (23), (27), (28), (35), theory (22) to (24): `CORRECTS` is one of
/// [`NONE`], [`FULL`] and [`STRESS`], `ARTIFICIAL` says whether there is artificial viscosity, `CROWDING`
/// whether particles are shifted by SPST.
#[derive(Clone, Copy, Debug)]
pub struct Forces<const D: usize, const CORRECTS: u8, const ARTIFICIAL: bool, const CROWDING: bool>(
    pub ForceConstants,
);

record! {
    /// What [`Forces`] sums, in m/s^2 but for the last three.
    pub struct ForceSums<D> in ForceSum {
        /// `- sum m_b (p_a / rho_a^2 + p_b / rho_b^2) grad W_ab` among the fluid.
        pub pressure: Components<D>,
        /// Viscosity among the fluid.
        pub viscosity: Components<D>,
        /// Artificial viscosity.
        pub artificial_viscosity: Components<D>,
        /// Pressure and viscosity of walls.
        pub walls: Components<D>,
        /// `sum V_b (u_b - u_a) d_a . grad W_ab`, or the corrections of CTVF (27).
        pub carried: Components<D>,
        /// `sum V_b grad W_ab` in 1/m.
        pub volume: Components<D>,
        /// `sum V_b (1 + R (W_ab / W(dx))^4) grad W_ab` of CTVF (35) in 1/m.
        pub crowding: Components<D>,
        /// `sum m_b W_ab` in kg/m^3.
        pub filling: One,
    }
}

impl<const D: usize, const CORRECTS: u8, const ARTIFICIAL: bool, const CROWDING: bool>
    Forces<D, CORRECTS, ARTIFICIAL, CROWDING>
{
    const NEEDS: Needs = if CROWDING { Needs::Both } else { Needs::Slope };

    /// Adds the forces of a neighbour of the same fluid other than its pressure.
    #[inline(always)]
    pub(super) fn resist<T: Number>(
        &self,
        [me, other]: [&Side<T, D>; 2],
        pair: &Of<MovingPair<D>, T>,
        sums: &mut ForceSums<T, D>,
    ) {
        let slope = other.mass() * pair.slope;
        let jump = difference(&me.velocity, &other.velocity);
        let densities = me.density + other.density;
        let scale = fluid::exchange_scale(densities, pair.square, self.0.softening);
        let ForceConstants { viscous, viscosity, .. } = self.0;
        let (way, exchange) = viscous.force(viscosity, &jump, pair, [slope, densities, scale]);
        for i in 0..D {
            sums.viscosity[i] += way[i] * exchange;
        }
        if ARTIFICIAL {
            let approach = dot(&jump, &pair.separation);
            let strength = T::from(self.0.artificial);
            let push = slope * fluid::artificial_viscosity(strength, approach, scale);
            for i in 0..D {
                sums.artificial_viscosity[i] -= pair.separation[i] * push;
            }
        }
    }

    /// Adds what the corrections and the shifting need, with the separation by which gradients at the particle are taken.
    #[inline(always)]
    pub(super) fn carry<T: Number>(
        &self,
        [me, other]: [&Side<T, D>; 2],
        arm: &Of<Components<D>, T>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut ForceSums<T, D>,
    ) {
        let slope = other.volume * pair.slope;
        if CORRECTS != NONE {
            let mine = dot(&me.deviation, arm) * slope;
            let jump = difference(&me.velocity, &other.velocity);
            if CORRECTS == FULL {
                for i in 0..D {
                    sums.carried[i] -= jump[i] * mine;
                }
            } else {
                let carried = dot(&other.deviation, &pair.separation) * slope;
                let opening = dot(&jump, &pair.separation) * slope;
                let ratio = other.density * me.density.recip();
                let stretch = mine * ratio + (mine - carried + opening) * self.0.dilatation;
                for i in 0..D {
                    sums.carried[i] += other.velocity[i] * carried + me.velocity[i] * stretch;
                }
            }
        }
        if CROWDING {
            sums.filling += other.mass() * pair.value;
            let factor = fluid::repulsion(pair.value * self.0.crowding);
            for i in 0..D {
                let area = pair.separation[i] * slope;
                sums.volume[i] += area;
                sums.crowding[i] += area * factor;
            }
        }
    }
}

impl<const D: usize, const CORRECTS: u8, const ARTIFICIAL: bool, const CROWDING: bool> PairLaw
    for Forces<D, CORRECTS, ARTIFICIAL, CROWDING>
{
    type Pair = MovingPair<D>;
    type Side = FluidSide<D>;
    type Sums = ForceSum<D>;

    const NEEDS: Needs = Self::NEEDS;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        me: &Side<T, D>,
        other: &Side<T, D>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut ForceSums<T, D>,
    ) {
        let pressure = pressed([me, other], pair, other.mass() * pair.slope);
        for i in 0..D {
            sums.pressure[i] -= pressure[i];
        }
        self.resist([me, other], pair, sums);
        self.carry([me, other], &pair.separation, pair, sums);
    }
}

/// `(p_a / rho_a^2 + p_b / rho_b^2) grad W_ab` of theory (22) with a multiple of the slope of the kernel.
#[inline(always)]
fn pressed<T: Number, const D: usize>(
    [me, other]: [&Side<T, D>; 2],
    pair: &Of<MovingPair<D>, T>,
    slope: T,
) -> Of<Components<D>, T> {
    let mut push = pair.separation;
    let pressure = slope * (me.load + other.load);
    for i in 0..D {
        push[i] *= pressure;
    }
    push
}

/// What walls do to a fluid, in the sums of its [`Forces`]. A side has besides the velocity of the
/// wall that viscous forces see.
#[derive(Clone, Copy, Debug)]
pub struct WallForces<L>(pub L);

impl<const D: usize, const CORRECTS: u8, const ARTIFICIAL: bool, const CROWDING: bool> PairLaw
    for WallForces<Forces<D, CORRECTS, ARTIFICIAL, CROWDING>>
{
    type Pair = MovingPair<D>;
    type Side = (FluidSide<D>, Components<D>);
    type Sums = ForceSum<D>;

    const NEEDS: Needs = Forces::<D, CORRECTS, ARTIFICIAL, CROWDING>::NEEDS;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        (me, _): &Of<Self::Side, T>,
        (other, shear): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut ForceSums<T, D>,
    ) {
        let wall = Wall::of(&self.0.0);
        wall.act([me, other], &difference(&me.velocity, shear), pair, &mut sums.walls);
        self.0.carry([me, other], &pair.separation, pair, sums);
    }
}

/// What a fluid does to a wall particle: pressure and viscosity, in m/s^2. There is no artificial
/// viscosity, which would hold back a fluid that slides.
#[derive(Clone, Copy, Debug)]
pub struct Wall<const D: usize> {
    /// `0.01 h^2` in m^2.
    pub softening: f64,
    /// Kinematic viscosity in m^2/s.
    pub viscosity: f64,
    /// Which form viscous forces have.
    pub viscous: Viscous,
}

impl<const D: usize> Wall<D> {
    /// That of a fluid with these constants.
    pub fn of(&ForceConstants { softening, viscosity, viscous, .. }: &ForceConstants) -> Self {
        Self { softening, viscosity, viscous }
    }

    /// Adds the force of another particle, one of the two of a wall, where velocities differ by a `jump` in m/s.
    #[inline(always)]
    pub fn act<T: Number>(
        &self,
        [me, other]: [&Side<T, D>; 2],
        jump: &Of<Components<D>, T>,
        pair: &Of<MovingPair<D>, T>,
        sum: &mut Of<Components<D>, T>,
    ) {
        let pressure = pressed([me, other], pair, pair.slope);
        self.push([me, other], [jump, &pressure], pair, sum);
    }

    /// The same with the pressure of the two times the gradient of the kernel.
    #[inline(always)]
    pub(super) fn push<T: Number>(
        &self,
        [me, other]: [&Side<T, D>; 2],
        [jump, pressure]: [&Of<Components<D>, T>; 2],
        pair: &Of<MovingPair<D>, T>,
        sum: &mut Of<Components<D>, T>,
    ) {
        let densities = me.density + other.density;
        let scale = fluid::exchange_scale(densities, pair.square, self.softening);
        let mass = other.mass();
        let factors = [pair.slope, densities, scale];
        let (way, exchange) = self.viscous.force(self.viscosity, jump, pair, factors);
        for i in 0..D {
            sum[i] += (way[i] * exchange - pressure[i]) * mass;
        }
    }
}

impl<const D: usize> PairLaw for Wall<D> {
    type Pair = MovingPair<D>;
    type Side = (FluidSide<D>, Components<D>);
    type Sums = Components<D>;

    const NEEDS: Needs = Needs::Slope;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        (me, shear): &Of<Self::Side, T>,
        (other, _): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sum: &mut Of<Components<D>, T>,
    ) {
        self.act([me, other], &difference(shear, &other.velocity), pair, sum);
    }
}

/// The constants of [`Rates`].
#[derive(Clone, Copy, Debug)]
pub struct RateConstants {
    /// `0.01 h^2` in m^2.
    pub softening: f64,
    /// `alpha h c / 8` of CTVF (24) in m^2/s.
    pub diffusivity: f64,
}

impl RateConstants {
    /// What of the pressure is exchanged with a neighbour, in Pa/s: of E_a in theory (23).
    #[inline(always)]
    pub(super) fn exchange<const FALLS: bool, T: Number, const D: usize>(
        &self,
        [me, other]: [&Side<T, D>; 2],
        half_force: &Of<Components<D>, T>,
        pair: &Of<MovingPair<D>, T>,
    ) -> T {
        let jump = other.pressure - me.pressure;
        let densities = me.density + other.density;
        let scale = fluid::exchange_scale(densities, pair.square, self.softening);
        let slope = other.mass() * pair.slope;
        let exchange = fluid::diffusion(self.diffusivity, pair.square, slope, scale);
        // In a fluid at rest this is the difference of pressure between the two, which must not diffuse.
        let at_rest = if FALLS { dot(half_force, &pair.separation) * densities } else { T::zero() };
        exchange * (jump + at_rest)
    }
}

/// The rates of the pressure, CTVF (23), (26), theory (21): `CORRECTS` says whether the
/// deviation carries it, `MOVES` whether the divergence is that of the transport velocity, `FALLS`
/// whether there are body forces. Beside a side stands half of the body force in m/s^2, which is
/// read of the particle itself only.
#[derive(Clone, Copy, Debug)]
pub struct Rates<const D: usize, const CORRECTS: bool, const MOVES: bool, const FALLS: bool>(
    pub RateConstants,
);

record! {
    /// What [`Rates`] sums.
    pub struct RateSums<D> in RateSum {
        /// `div u` in 1/s, or `div uhat`.
        pub divergence: One,
        /// `d . grad p` in Pa/s.
        pub pressure_transport: One,
        /// Diffusion of the pressure in Pa/s.
        pub pressure_diffusion: One,
    }
}

impl<const D: usize, const CORRECTS: bool, const MOVES: bool, const FALLS: bool> PairLaw
    for Rates<D, CORRECTS, MOVES, FALLS>
{
    type Pair = MovingPair<D>;
    type Side = (FluidSide<D>, Components<D>);
    type Sums = RateSum<D>;

    const NEEDS: Needs = Needs::Slope;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        (me, half_force): &Of<Self::Side, T>,
        (other, _): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut RateSums<T, D>,
    ) {
        let slope = other.volume * pair.slope;
        let mut flow = difference(&me.velocity, &other.velocity);
        if MOVES {
            let apart = difference(&me.deviation, &other.deviation);
            for i in 0..D {
                flow[i] += apart[i];
            }
        }
        sums.divergence -= dot(&flow, &pair.separation) * slope;
        let jump = other.pressure - me.pressure;
        if CORRECTS {
            sums.pressure_transport += dot(&me.deviation, &pair.separation) * slope * jump;
        }
        sums.pressure_diffusion -= self.0.exchange::<FALLS, T, D>([me, other], half_force, pair);
    }
}
