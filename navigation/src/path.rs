//! Relative elements over time: drift between impulses, and their derivatives with respect to the parameters
//! of an estimation.

use contract::navigation::RelativeElements;
use nalgebra::{Matrix6xX, Vector3};

use crate::orbit::Orbit;
use crate::reference::{Reference, kicked};
use crate::relative::{self, DriftPartials, between, control_matrix};
use crate::short_period::Osculation;

/// Impulse of the chaser in an estimation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EstimatedImpulse {
    /// Time, s since the epoch.
    pub(crate) seconds: f64,
    /// Change of velocity along the chaser's R, T, N axes, m/s: reported plus estimated correction.
    pub(crate) dv_m_s: Vector3<f64>,
    /// Index of the parameter that corrects each component.
    pub(crate) columns: [Option<usize>; 3],
}

/// Relative orbit that determines a [`Path`].
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PathSetup<'a> {
    /// Absolute orbit of the chaser.
    pub(crate) reference: &'a Reference,
    /// Mean relative elements at the epoch, parameters 0 to 5.
    pub(crate) elements: RelativeElements,
    /// Rate of aδa, m/s.
    pub(crate) drag_m_s: f64,
    /// Index of the parameter of the rate of aδa.
    pub(crate) drag_column: Option<usize>,
    /// Impulses in order of time.
    pub(crate) impulses: &'a [EstimatedImpulse],
    /// Number of parameters.
    pub(crate) parameters: usize,
}

/// Relative elements over all times.
#[derive(Debug, Clone)]
pub(crate) struct Path {
    legs: Vec<Leg>,
    drag_m_s: f64,
    drag_column: Option<usize>,
}

/// Drift between two impulses.
#[derive(Debug, Clone)]
struct Leg {
    /// Start of validity, s.
    from_s: f64,
    /// Drift from the anchor.
    drift: Drift,
    /// Derivatives of the elements at the anchor with respect to the parameters, 6 × parameters.
    sensitivity: Matrix6xX<f64>,
}

/// Drift of relative elements from an anchor: the difference of the secular drifts of two orbits, exact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Drift {
    anchor_s: f64,
    elements: RelativeElements,
    chaser: Orbit,
    target: Orbit,
    /// Drift of aδλ and aδiy, m/s.
    lambda_rate: f64,
    node_rate: f64,
    partials: DriftPartials,
}

impl Drift {
    /// Creates the drift of `elements` of a chaser in the mean orbit `chaser` at `anchor_s`.
    pub(crate) fn new(anchor_s: f64, elements: RelativeElements, chaser: Orbit) -> Option<Self> {
        let target = relative::target(&chaser, &elements);
        target.is_supported().then_some(())?;
        let (of_chaser, of_target) = (chaser.secular_rates(), target.secular_rates());
        let a_m = target.a_km * 1000.0;
        let (sin_i, cos_i) = libm::sincos(target.i);
        let raan = of_chaser.raan - of_target.raan;
        Some(Self {
            anchor_s,
            elements,
            chaser,
            target,
            lambda_rate: a_m * (of_chaser.u - of_target.u + raan * cos_i),
            node_rate: a_m * raan * sin_i,
            partials: DriftPartials::new(&target),
        })
    }

    /// Returns the elements at a time, with a rate of aδa, m/s, since the anchor.
    pub(crate) fn at(&self, seconds: f64, drag_m_s: f64) -> RelativeElements {
        let dt = seconds - self.anchor_s;
        let a_m = self.target.a_km * 1000.0;
        let rotated = |orbit: &Orbit| {
            let (sin, cos) = libm::sincos(orbit.secular_rates().perigee * dt);
            (cos * orbit.ex - sin * orbit.ey, sin * orbit.ex + cos * orbit.ey)
        };
        let (chaser, target) = (rotated(&self.chaser), rotated(&self.target));
        let drag = self.partials.drag(dt) * drag_m_s;
        RelativeElements {
            a_da_m: self.elements.a_da_m + drag[0],
            a_dlambda_m: self.elements.a_dlambda_m + self.lambda_rate * dt + drag[1],
            a_dex_m: a_m * (chaser.0 - target.0),
            a_dey_m: a_m * (chaser.1 - target.1),
            a_dix_m: self.elements.a_dix_m,
            a_diy_m: self.elements.a_diy_m + self.node_rate * dt + drag[5],
        }
    }
}

impl Path {
    /// Propagates the elements from the epoch through the impulses, forwards and backwards. `None` where the
    /// chaser's orbit is unknown at an impulse or an orbit is not supported.
    pub(crate) fn new(setup: &PathSetup<'_>) -> Option<Self> {
        let PathSetup { reference, elements, drag_m_s, drag_column, impulses, parameters } = setup;
        let mut sensitivity = Matrix6xX::zeros(*parameters);
        sensitivity.view_mut((0, 0), (6, 6)).fill_with_identity();
        let drift = Drift::new(0.0, *elements, reference.orbit(0.0)?)?;
        let mut path = Self {
            legs: vec![Leg { from_s: f64::NEG_INFINITY, drift, sensitivity }],
            drag_m_s: *drag_m_s,
            drag_column: *drag_column,
        };
        let (earlier, later) = impulses.split_at(impulses.partition_point(|impulse| impulse.seconds <= 0.0));
        for impulse in later {
            let leg = path.next_leg(path.legs.last()?, impulse, reference, 1.0)?;
            path.legs.push(leg);
        }
        for impulse in earlier.iter().rev() {
            let leg = path.next_leg(path.legs.first()?, impulse, reference, -1.0)?;
            path.legs.first_mut()?.from_s = impulse.seconds;
            path.legs.insert(0, Leg { from_s: f64::NEG_INFINITY, ..leg });
        }
        Some(path)
    }

    /// Returns the leg on the other side of an impulse: after it for `sign` 1, before it for −1.
    fn next_leg(
        &self,
        leg: &Leg,
        impulse: &EstimatedImpulse,
        reference: &Reference,
        sign: f64,
    ) -> Option<Leg> {
        let EstimatedImpulse { seconds, dv_m_s, columns } = impulse;
        let mut sensitivity = self.element_sensitivity(leg, *seconds);
        let (near, far) = if sign > 0.0 {
            (reference.orbit_before(*seconds)?, reference.orbit(*seconds)?)
        } else {
            (reference.orbit(*seconds)?, reference.orbit_before(*seconds)?)
        };
        let elements = leg.drift.at(*seconds, self.drag_m_s);
        let elements = applied(&elements, &near, &(dv_m_s * sign), reference.osculation())?;
        let control = control_matrix(&near) * sign;
        for (axis, column) in columns.iter().enumerate() {
            if let Some(column) = column {
                let mut target = sensitivity.column_mut(*column);
                target += control.column(axis);
            }
        }
        Some(Leg { from_s: *seconds, drift: Drift::new(*seconds, elements, far)?, sensitivity })
    }

    /// Derivatives of the elements at a time within a leg.
    fn element_sensitivity(&self, leg: &Leg, seconds: f64) -> Matrix6xX<f64> {
        let dt = seconds - leg.drift.anchor_s;
        let mut sensitivity = leg.drift.partials.transition(dt) * &leg.sensitivity;
        if let Some(column) = self.drag_column {
            let mut target = sensitivity.column_mut(column);
            target += leg.drift.partials.drag(dt);
        }
        sensitivity
    }

    fn leg(&self, seconds: f64) -> Option<&Leg> {
        let index = self.legs.partition_point(|leg| leg.from_s <= seconds).saturating_sub(1);
        self.legs.get(index)
    }

    /// Returns the relative elements at a time; at an impulse, those after it.
    pub(crate) fn at(&self, seconds: f64) -> Option<RelativeElements> {
        Some(self.leg(seconds)?.drift.at(seconds, self.drag_m_s))
    }

    /// Returns the derivatives of the elements at a time with respect to the parameters, 6 × parameters.
    pub(crate) fn sensitivity_at(&self, seconds: f64) -> Option<Matrix6xX<f64>> {
        Some(self.element_sensitivity(self.leg(seconds)?, seconds))
    }

    /// Writes H S(t) to `row` for a row H of derivatives with respect to the elements at a time.
    pub(crate) fn pull_back(&self, seconds: f64, by_elements: &[f64; 6], row: &mut [f64]) {
        let Some(leg) = self.leg(seconds) else { return };
        let dt = seconds - leg.drift.anchor_s;
        let transition = leg.drift.partials.transition(dt);
        let mut at_anchor = [0.0; 6];
        for (column, value) in at_anchor.iter_mut().enumerate() {
            *value = (0..6).map(|k| by_elements[k] * transition[(k, column)]).sum();
        }
        for (column, value) in leg.sensitivity.column_iter().zip(row.iter_mut()) {
            *value += column.iter().zip(&at_anchor).map(|(s, h)| s * h).sum::<f64>();
        }
        if let Some(column) = self.drag_column {
            let drag = leg.drift.partials.drag(dt);
            row[column] += (0..6).map(|k| by_elements[k] * drag[k]).sum::<f64>();
        }
    }
}

/// Returns the relative elements after an impulse of the chaser, exact: the chaser's state changes, the
/// target's orbit does not.
pub(crate) fn applied(
    elements: &RelativeElements,
    chaser: &Orbit,
    dv_m_s: &Vector3<f64>,
    osculation: Osculation,
) -> Option<RelativeElements> {
    let target = relative::target(chaser, elements);
    Some(between(&kicked(chaser, dv_m_s, osculation)?, &target))
}
