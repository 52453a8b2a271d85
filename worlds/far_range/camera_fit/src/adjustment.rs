//! Least-squares adjustment of one camera and the attitudes of its frames to the stars of all of them.
//!
//! Unknowns are the camera ([`CameraTerms`], those that are free) and three small turns per frame. Every
//! unknown of the camera has a prior (a first value with a standard deviation), so that what the stars do not
//! determine keeps it, and its error is stated as that of the prior. Gauss–Newton steps with Levenberg's
//! damping; residuals beyond 2.5 standard deviations count less (Huber 1964).

use contract::{Camera, CameraFrame, Icrs, PixelPoint, Rotation};
use nalgebra::{DMatrix, DVector, Vector3};
use pipeline::CameraModel;

/// Number of unknowns of a camera.
pub const TERMS: usize = 8;

/// First value of the common error of positions, px, and number of rounds in which it is found.
const FIRST_COMMON_PX: f64 = 0.1;
const ERROR_ROUNDS: usize = 4;

/// Residual, standard deviations, beyond which its weight falls.
const ROBUST_LIMIT: f64 = 2.5;

/// Largest number of steps, relative decrease of the sum below which they end, and largest damping.
const MAX_STEPS: usize = 60;
const MIN_DECREASE: f64 = 1e-9;
const MAX_DAMPING: f64 = 1e10;

/// Step of the numerical derivatives, in units of the unknowns, which are all of the order of 1.
const DERIVATIVE_STEP: f64 = 1e-6;

/// Median of χ² with two degrees of freedom.
const MEDIAN_CHI2: f64 = 1.386_294_361_119_890_6;

/// An unknown of a camera. In the adjustment, the unknowns have no unit: lengths are in units of half the
/// diagonal of the detector, h.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Term {
    /// Natural logarithm of the focal length.
    FocalLength,
    /// Column of the principal point, h.
    PrincipalX,
    /// Row of the principal point, h.
    PrincipalY,
    /// k1 h².
    Radial1,
    /// k2 h⁴.
    Radial2,
    /// k3 h⁶.
    Radial3,
    /// p1 h.
    Tangential1,
    /// p2 h.
    Tangential2,
}

impl Term {
    /// All terms, in the order of [`CameraTerms`].
    pub const ALL: [Self; TERMS] = [
        Self::FocalLength,
        Self::PrincipalX,
        Self::PrincipalY,
        Self::Radial1,
        Self::Radial2,
        Self::Radial3,
        Self::Tangential1,
        Self::Tangential2,
    ];

    /// Name of the parameter, with its unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::FocalLength => "focal length, mm",
            Self::PrincipalX => "principal point x, px",
            Self::PrincipalY => "principal point y, px",
            Self::Radial1 => "k1, px^-2",
            Self::Radial2 => "k2, px^-4",
            Self::Radial3 => "k3, px^-6",
            Self::Tangential1 => "p1, px^-1",
            Self::Tangential2 => "p2, px^-1",
        }
    }

    /// Returns the parameter of a camera that the term changes: mm, px, px⁻², px⁻⁴, px⁻⁶, px⁻¹.
    pub fn parameter(self, camera: &Camera) -> f64 {
        let [k1, k2, k3] = camera.radial;
        let [p1, p2] = camera.tangential;
        match self {
            Self::FocalLength => camera.focal_length_mm,
            Self::PrincipalX => camera.principal_x_px,
            Self::PrincipalY => camera.principal_y_px,
            Self::Radial1 => k1,
            Self::Radial2 => k2,
            Self::Radial3 => k3,
            Self::Tangential1 => p1,
            Self::Tangential2 => p2,
        }
    }

    /// Standard deviation of the prior, in units of the unknown: 20 % of the focal length, 10 % of h for the
    /// principal point (sensors are mounted to some 2 % of their size); of the position at the corner, 20 %,
    /// 5 % and 2 % for the radial terms and 0.2 % for the tangential ones.
    pub fn prior_sigma(self) -> f64 {
        match self {
            Self::FocalLength => 0.2,
            Self::PrincipalX | Self::PrincipalY => 0.1,
            Self::Radial1 => 0.2,
            Self::Radial2 => 0.05,
            Self::Radial3 => 0.02,
            Self::Tangential1 | Self::Tangential2 => 0.002,
        }
    }
}

/// Values of the unknowns of a camera, in the order of [`Term::ALL`]: differences from the first camera in
/// their units.
pub type CameraTerms = [f64; TERMS];

/// A star of a frame: the place where it was measured, and its direction.
#[derive(Debug, Clone, Copy)]
pub struct Observation {
    /// Index of the frame among those adjusted.
    pub frame: usize,
    /// Measured position, px.
    pub position: PixelPoint,
    /// Standard deviation of the measured position along an axis, px.
    pub sigma_px: f64,
    /// Catalogue number of the star.
    pub star: u32,
    /// Apparent direction of the star.
    pub direction: Vector3<f64>,
}

/// Camera and attitudes that fit the observations, with the covariance of the camera.
#[derive(Debug, Clone)]
pub struct Adjustment {
    /// Values of the unknowns.
    pub terms: CameraTerms,
    /// Attitude of each frame.
    pub attitudes: Vec<Rotation<CameraFrame, Icrs>>,
    /// Covariance of the unknowns of the camera; 0 for those that are not free.
    pub covariance: [[f64; TERMS]; TERMS],
    /// Errors of the positions.
    pub errors: PositionErrors,
    /// Residual of each observation, measured minus computed, px; NaN behind the camera.
    pub residuals: Vec<[f64; 2]>,
}

/// Errors of positions that their stated standard deviations lack or exceed: found from the residuals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionErrors {
    /// Standard deviation of an error that all positions have, along an axis, px: photon noise, structure of
    /// the profile within a pixel, the star list.
    pub common_px: f64,
    /// Factor on the stated standard deviations; less than 1 only if there is no common error.
    pub scale: f64,
}

impl PositionErrors {
    /// Returns the standard deviation of a position with a stated one, px.
    pub fn sigma_px(&self, stated_px: f64) -> f64 {
        self.scale * libm::hypot(stated_px, self.common_px)
    }
}

/// Largest common error of positions, px, and number of halvings in its search.
const MAX_COMMON_PX: f64 = 10.0;
const HALVINGS: usize = 40;

/// Smallest factor on stated standard deviations.
const MIN_SCALE: f64 = 0.3;

/// Mapping of directions by a camera with unknown terms.
#[derive(Debug, Clone)]
pub struct AdjustedCamera {
    first: Camera,
    /// Half of the diagonal of the detector, px.
    half_diagonal_px: f64,
}

impl AdjustedCamera {
    /// Creates the mapping about a first camera.
    pub fn new(first: &Camera) -> Self {
        let half_diagonal_px = 0.5 * libm::hypot(first.columns as f64, first.rows as f64);
        Self { first: first.clone(), half_diagonal_px }
    }

    /// Returns the camera with the given terms.
    pub fn camera(&self, terms: &CameraTerms) -> Camera {
        let [focal, x, y, k1, k2, k3, p1, p2] = *terms;
        let h = self.half_diagonal_px;
        let first = &self.first;
        Camera {
            focal_length_mm: first.focal_length_mm * libm::exp(focal),
            principal_x_px: first.principal_x_px + x * h,
            principal_y_px: first.principal_y_px + y * h,
            radial: [
                first.radial[0] + k1 / (h * h),
                first.radial[1] + k2 / libm::pow(h, 4.0),
                first.radial[2] + k3 / libm::pow(h, 6.0),
            ],
            tangential: [first.tangential[0] + p1 / h, first.tangential[1] + p2 / h],
            ..first.clone()
        }
    }

    /// Returns the mapping of the camera with the given terms; `None` for a camera that is not possible.
    pub fn model(&self, terms: &CameraTerms) -> Option<CameraModel> {
        CameraModel::new(&self.camera(terms)).ok()
    }

    /// Returns the standard deviation of the parameter of a camera for that of its unknown: mm, px, px⁻²,
    /// px⁻⁴, px⁻⁶, px⁻¹.
    pub fn parameter_sigma(&self, term: Term, sigma: f64, camera: &Camera) -> f64 {
        let h = self.half_diagonal_px;
        match term {
            Term::FocalLength => sigma * camera.focal_length_mm,
            Term::PrincipalX | Term::PrincipalY => sigma * h,
            Term::Radial1 => sigma / (h * h),
            Term::Radial2 => sigma / libm::pow(h, 4.0),
            Term::Radial3 => sigma / libm::pow(h, 6.0),
            Term::Tangential1 | Term::Tangential2 => sigma / h,
        }
    }
}

/// Adjusts the free terms of a camera and the attitudes of frames to observations. `attitudes` are first
/// values. Returns `None` if the observations do not determine the attitudes.
pub fn adjust(
    camera: &AdjustedCamera,
    free: &[Term],
    attitudes: &[Rotation<CameraFrame, Icrs>],
    observations: &[Observation],
) -> Option<Adjustment> {
    let mut state = State { terms: [0.0; TERMS], attitudes: attitudes.to_vec() };
    let problem = Problem { camera, free, observations };
    let mut errors = PositionErrors { common_px: FIRST_COMMON_PX, scale: 1.0 };
    // The errors are the weights, and change the residuals from which they are found.
    for _ in 0..ERROR_ROUNDS {
        state = problem.solve(state, errors)?;
        errors = problem.position_errors(&state);
    }
    state = problem.solve(state, errors)?;
    let of_all = problem.covariance(&state, errors)?;
    let mut covariance = [[0.0; TERMS]; TERMS];
    for (i, a) in free.iter().enumerate() {
        for (j, b) in free.iter().enumerate() {
            covariance[*a as usize][*b as usize] = of_all[(i, j)];
        }
    }
    let residuals = problem.residuals(&state);
    Some(Adjustment { terms: state.terms, attitudes: state.attitudes, covariance, errors, residuals })
}

/// Returns the share of given displacements in the residuals of an adjustment, and its standard deviation:
/// Σ over the observations as for another unknown, adjusted together with all others. `displaced` has the
/// displaced direction of each observation. `None` if the observations do not determine the share.
pub(crate) fn displacement_share(
    camera: &AdjustedCamera,
    free: &[Term],
    adjustment: &Adjustment,
    observations: &[Observation],
    displaced: &[Vector3<f64>],
) -> Option<[f64; 2]> {
    let problem = Problem { camera, free, observations };
    let state = State { terms: adjustment.terms, attitudes: adjustment.attitudes.clone() };
    let model = camera.model(&state.terms);
    let information = problem.equations(&state, adjustment.errors).0;
    let rows = problem.linearised(&state, adjustment.errors);
    if rows.len() != observations.len() {
        return None;
    }
    // Information of the share, its products with the other unknowns, and its gradient.
    let (mut own, mut gradient) = (0.0, 0.0);
    let mut mixed = DVector::zeros(information.nrows());
    for ((observation, row), displaced) in observations.iter().zip(&rows).zip(displaced) {
        let attitude = &state.attitudes[observation.frame];
        let at = project(model.as_ref(), &attitude.rotate(&observation.direction))?;
        let moved = project(model.as_ref(), &attitude.rotate(displaced))?;
        let along = [moved.x - at.x, moved.y - at.y];
        own += row.weight * (along[0] * along[0] + along[1] * along[1]);
        gradient += row.gradient_along(&along);
        for (i, slope) in &row.slopes {
            mixed[*i] += row.weight * (slope[0] * along[0] + slope[1] * along[1]);
        }
    }
    let left = own - mixed.dot(&information.cholesky()?.solve(&mixed));
    (left > 0.0).then(|| [gradient / left, 1.0 / left.sqrt()])
}

/// Values of all unknowns.
#[derive(Clone)]
struct State {
    terms: CameraTerms,
    attitudes: Vec<Rotation<CameraFrame, Icrs>>,
}

/// An observation with the derivatives of its computed position.
struct Linearised {
    /// Measured minus computed position, px.
    residual: [f64; 2],
    /// Weight, px⁻².
    weight: f64,
    /// Derivatives by the unknowns, by their index: the free terms of the camera, then three turns per frame.
    slopes: Vec<(usize, [f64; 2])>,
}

impl Linearised {
    /// Returns the gradient along an unknown with the given derivatives.
    fn gradient_along(&self, slope: &[f64; 2]) -> f64 {
        self.weight * (slope[0] * self.residual[0] + slope[1] * self.residual[1])
    }
}

struct Problem<'a> {
    camera: &'a AdjustedCamera,
    free: &'a [Term],
    observations: &'a [Observation],
}

impl Problem<'_> {
    /// Returns the unknowns with the smallest weighted sum of squares.
    fn solve(&self, mut state: State, errors: PositionErrors) -> Option<State> {
        let mut cost = self.cost(&state, errors);
        let mut damping = 1e-3;
        for _ in 0..MAX_STEPS {
            let (information, gradient) = self.equations(&state, errors);
            let mut damped = information.clone();
            for i in 0..damped.nrows() {
                damped[(i, i)] *= 1.0 + damping;
            }
            let step = damped.cholesky()?.solve(&gradient);
            let next = self.moved(&state, &step);
            let next_cost = self.cost(&next, errors);
            if next_cost < cost {
                let decrease = (cost - next_cost) / cost;
                (state, cost) = (next, next_cost);
                damping *= 0.1;
                if decrease < MIN_DECREASE {
                    break;
                }
            } else {
                damping *= 10.0;
                if damping > MAX_DAMPING {
                    break;
                }
            }
        }
        cost.is_finite().then_some(state)
    }

    /// Returns the state after a step: the free terms of the camera first, then a turn about the camera's
    /// axes, rad, per frame.
    fn moved(&self, state: &State, step: &DVector<f64>) -> State {
        let mut moved = state.clone();
        for (index, term) in self.free.iter().enumerate() {
            moved.terms[*term as usize] += step[index];
        }
        for (frame, attitude) in moved.attitudes.iter_mut().enumerate() {
            let first = self.free.len() + 3 * frame;
            let turn = Vector3::new(step[first], step[first + 1], step[first + 2]);
            *attitude = Rotation::<CameraFrame, CameraFrame>::from_rotation_vector(turn) * *attitude;
        }
        moved
    }

    /// Returns the normal equations: information matrix, and the gradient towards the solution.
    fn equations(&self, state: &State, errors: PositionErrors) -> (DMatrix<f64>, DVector<f64>) {
        let count = self.free.len() + 3 * state.attitudes.len();
        let (mut information, mut gradient) = (DMatrix::zeros(count, count), DVector::zeros(count));
        for (index, term) in self.free.iter().enumerate() {
            let weight = 1.0 / (term.prior_sigma() * term.prior_sigma());
            information[(index, index)] += weight;
            gradient[index] -= weight * state.terms[*term as usize];
        }
        for row in self.linearised(state, errors) {
            for (i, a) in &row.slopes {
                gradient[*i] += row.gradient_along(a);
                for (j, b) in &row.slopes {
                    information[(*i, *j)] += row.weight * (a[0] * b[0] + a[1] * b[1]);
                }
            }
        }
        (information, gradient)
    }

    /// Returns the covariance of all unknowns, N⁻¹ (S + P) N⁻¹ with the information N, the information P of
    /// the priors and the scatter S of the gradients of the single observations (White 1980, Econometrica 48,
    /// 817): it holds for positions with other errors than the assumed ones, too. S is enlarged by the share
    /// of the residuals that the unknowns have absorbed. Not less than N⁻¹, which few observations can fall
    /// below by chance.
    fn covariance(&self, state: &State, errors: PositionErrors) -> Option<DMatrix<f64>> {
        let information = self.equations(state, errors).0;
        let count = information.nrows();
        let inverse = information.cholesky()?.inverse();
        let enlarged = 1.0 / self.share_left(state);
        let mut scatter = DMatrix::zeros(count, count);
        for (index, term) in self.free.iter().enumerate() {
            scatter[(index, index)] += 1.0 / (term.prior_sigma() * term.prior_sigma());
        }
        for row in self.linearised(state, errors) {
            for (i, a) in &row.slopes {
                for (j, b) in &row.slopes {
                    scatter[(*i, *j)] += enlarged * row.gradient_along(a) * row.gradient_along(b);
                }
            }
        }
        let robust = &inverse * scatter * &inverse;
        let growth: Vec<f64> =
            (0..count).map(|i| (inverse[(i, i)] / robust[(i, i)]).max(1.0).sqrt()).collect();
        Some(DMatrix::from_fn(count, count, |i, j| growth[i] * robust[(i, j)] * growth[j]))
    }

    /// Returns the share of the squared residuals that the unknowns leave: 1 − unknowns/coordinates.
    fn share_left(&self, state: &State) -> f64 {
        let coordinates = 2.0 * self.observations.len() as f64;
        let unknowns = (self.free.len() + 3 * state.attitudes.len()) as f64;
        (1.0 - unknowns / coordinates).max(0.1)
    }

    /// Returns residual, weight and derivatives of each observation in front of the camera.
    fn linearised(&self, state: &State, errors: PositionErrors) -> Vec<Linearised> {
        let model = self.camera.model(&state.terms);
        let varied: Vec<[Option<CameraModel>; 2]> =
            self.free.iter().map(|term| self.varied(state, *term)).collect();
        let mut rows = Vec::with_capacity(self.observations.len());
        for observation in self.observations {
            let direction = state.attitudes[observation.frame].rotate(&observation.direction);
            let Some(computed) = project(model.as_ref(), &direction) else { continue };
            let residual = [observation.position.x - computed.x, observation.position.y - computed.y];
            let mut slopes: Vec<(usize, [f64; 2])> = Vec::with_capacity(self.free.len() + 3);
            for (index, [lower, upper]) in varied.iter().enumerate() {
                if let Some(slope) =
                    slope(project(lower.as_ref(), &direction), project(upper.as_ref(), &direction))
                {
                    slopes.push((index, slope));
                }
            }
            for axis in 0..3 {
                let mut turn = Vector3::zeros();
                turn[axis] = DERIVATIVE_STEP;
                let turned =
                    |sign: f64| project(model.as_ref(), &(direction + (sign * turn).cross(&direction)));
                if let Some(slope) = slope(turned(-1.0), turned(1.0)) {
                    slopes.push((self.free.len() + 3 * observation.frame + axis, slope));
                }
            }
            let weight = weight(residual, errors.sigma_px(observation.sigma_px));
            rows.push(Linearised { residual, weight, slopes });
        }
        rows
    }

    /// Returns the cameras a step below and above the state in one term.
    fn varied(&self, state: &State, term: Term) -> [Option<CameraModel>; 2] {
        [-DERIVATIVE_STEP, DERIVATIVE_STEP].map(|step| {
            let mut terms = state.terms;
            terms[term as usize] += step;
            self.camera.model(&terms)
        })
    }

    fn residuals(&self, state: &State) -> Vec<[f64; 2]> {
        let model = self.camera.model(&state.terms);
        let mut residuals = Vec::with_capacity(self.observations.len());
        for observation in self.observations {
            let direction = state.attitudes[observation.frame].rotate(&observation.direction);
            residuals.push(match project(model.as_ref(), &direction) {
                Some(at) => [observation.position.x - at.x, observation.position.y - at.y],
                None => [f64::NAN; 2],
            });
        }
        residuals
    }

    /// Returns the sum of Huber's function of the residuals and of the squares of the priors.
    fn cost(&self, state: &State, errors: PositionErrors) -> f64 {
        let mut cost = 0.0;
        for term in self.free {
            let share = state.terms[*term as usize] / term.prior_sigma();
            cost += share * share;
        }
        for (observation, residual) in self.observations.iter().zip(self.residuals(state)) {
            let size = libm::hypot(residual[0], residual[1]) / errors.sigma_px(observation.sigma_px);
            cost += match size {
                size if size.is_nan() => 1e6,
                size if size <= ROBUST_LIMIT => size * size,
                size => ROBUST_LIMIT * (2.0 * size - ROBUST_LIMIT),
            };
        }
        cost
    }

    /// Returns the errors of positions with which the median of the squared residuals is that of χ². The
    /// unknowns have absorbed a part of the residuals, by the number of unknowns over that of coordinates.
    fn position_errors(&self, state: &State) -> PositionErrors {
        let residuals = self.residuals(state);
        let left = self.share_left(state);
        let ratio = |common_px: f64| {
            let mut squares = Vec::with_capacity(residuals.len());
            for (observation, [x, y]) in self.observations.iter().zip(&residuals) {
                let variance = observation.sigma_px * observation.sigma_px + common_px * common_px;
                squares.push((x * x + y * y) / variance);
            }
            squares.sort_by(f64::total_cmp);
            squares.get(squares.len() / 2).map_or(1.0, |median| median / MEDIAN_CHI2 / left)
        };
        let of_stated = ratio(0.0);
        if of_stated <= 1.0 {
            return PositionErrors { common_px: 0.0, scale: of_stated.sqrt().max(MIN_SCALE) };
        }
        let (mut low, mut high) = (0.0, MAX_COMMON_PX);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if ratio(middle) > 1.0 { low = middle } else { high = middle }
        }
        PositionErrors { common_px: high, scale: 1.0 }
    }
}

fn project(model: Option<&CameraModel>, direction: &Vector3<f64>) -> Option<PixelPoint> {
    model?.project_vector(direction)
}

/// Returns Huber's weight of a residual with a standard deviation along each axis.
fn weight(residual: [f64; 2], sigma_px: f64) -> f64 {
    let size = libm::hypot(residual[0], residual[1]) / sigma_px;
    let share = if size > ROBUST_LIMIT { ROBUST_LIMIT / size } else { 1.0 };
    share / (sigma_px * sigma_px)
}

fn slope(lower: Option<PixelPoint>, upper: Option<PixelPoint>) -> Option<[f64; 2]> {
    let (lower, upper) = (lower?, upper?);
    let step = 2.0 * DERIVATIVE_STEP;
    Some([(upper.x - lower.x) / step, (upper.y - lower.y) / step])
}
