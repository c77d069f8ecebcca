//! How a fiber scatters, as the scene asks for it: both models' lobes in f64, evaluated and drawn from.

use super::sky::Sky;
use crate::bsdf::khungurn::sample::{self, Sample};
use crate::bsdf::khungurn::{FiberScattering, bcsdf_cos_of_directions};
use crate::bsdf::simple::simple_specular_cos;
use crate::math::angle::{angle_of, longitudinal_angle};
use crate::math::frame::normal_perpendicular_to;
use crate::scene::Fabric;
use crate::scene::file::{ShadingModel, ShadingTable};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The highlight of a shading model.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Highlight {
    None,
    /// Wu & Yuksel 2019, Eq. 5: strength and width in radians.
    Simple(DVec3, f64),
    /// Khungurn et al. 2017.
    Physical(FiberScattering),
}

/// A fabric's fibers, as light meets them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    highlight: Highlight,
    /// Albedo of the diffuse lobe, 0 without one.
    diffuse: DVec3,
    /// Of its fibers, in mm.
    pub diameter_mm: f64,
}

/// A fiber met by a ray: all directions are unit and point away from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// The fiber's direction.
    pub tangent: DVec3,
    /// Of the round fiber, where the ray met it.
    pub normal: DVec3,
    /// Where the ray came from.
    pub to_eye: DVec3,
}

/// Shares of the directions that are drawn from the highlight and from a picture of the sky; the rest is of the
/// diffuse lobe.
const HIGHLIGHT_SHARE: f64 = 0.5;
const SKY_SHARE: f64 = 0.3;

impl Material {
    /// What a scene's shading makes of a fabric.
    pub fn new(shading: &ShadingTable, fabric: &Fabric) -> Self {
        let fiber = &fabric.fiber;
        let highlight = match (shading.specular, shading.model) {
            (false, _) => Highlight::None,
            (true, ShadingModel::Physical) => Highlight::Physical(fiber.scattering()),
            (true, ShadingModel::Simple) => {
                Highlight::Simple(DVec3::from_array(fiber.specular()), fiber.specular_width())
            }
        };
        let diffuse = if shading.diffuse { DVec3::from_array(fiber.diffuse()) } else { DVec3::ZERO };
        Self { highlight, diffuse, diameter_mm: 2.0 * fabric.yarn.fiber_radius_mm() }
    }

    fn diffuse(&self, meeting: &Meeting, to_light: DVec3) -> DVec3 {
        self.diffuse * (meeting.normal.dot(to_light).max(0.0) / PI)
    }

    /// Radiance toward the eye per irradiance from one direction, its cosine included.
    pub fn scatter(&self, meeting: &Meeting, to_light: DVec3) -> DVec3 {
        let Meeting { tangent, to_eye, .. } = *meeting;
        let highlight = match &self.highlight {
            Highlight::None => DVec3::ZERO,
            Highlight::Simple(strength, width) => {
                *strength * simple_specular_cos(tangent, to_light, to_eye, *width, 0.0)
            }
            Highlight::Physical(fiber) => {
                bcsdf_cos_of_directions(tangent, to_light, to_eye, 0.0, fiber).sum()
            }
        };
        self.diffuse(meeting, to_light) + highlight
    }

    /// The same of light from everywhere: the simple model's highlight is of lights alone.
    pub fn scatter_sky(&self, meeting: &Meeting, from_sky: DVec3) -> DVec3 {
        match self.highlight {
            Highlight::Simple(..) => self.diffuse(meeting, from_sky),
            _ => self.scatter(meeting, from_sky),
        }
    }

    /// Shares of the draws: highlight, sky, diffuse lobe.
    fn shares(&self, sky: &Sky) -> [f64; 3] {
        let of_sky = if sky.sample([0.5; 3]).is_some() { SKY_SHARE } else { 0.0 };
        let lobes = 1.0 - of_sky;
        match (self.highlight, self.diffuse.max_element() > 0.0) {
            (Highlight::Physical(_), true) => {
                [lobes * HIGHLIGHT_SHARE, of_sky, lobes * (1.0 - HIGHLIGHT_SHARE)]
            }
            (Highlight::Physical(_), false) => [lobes, of_sky, 0.0],
            _ => [0.0, of_sky, lobes],
        }
    }

    /// A direction of light by importance and its density per steradian, from four uniform numbers in [0, 1):
    /// one chooses what it is drawn from, the density is of all (the balance heuristic, Veach & Guibas 1995).
    /// `None` where there is nothing to draw from, or the density has no bound.
    pub fn sample(&self, meeting: &Meeting, sky: &Sky, u: [f64; 4]) -> Option<(DVec3, f64)> {
        let [highlight, of_sky, _] = self.shares(sky);
        let rest = [u[1], u[2], u[3]];
        let direction = if u[0] < highlight {
            self.sample_highlight(meeting, rest)?
        } else if u[0] < highlight + of_sky {
            sky.sample(rest)?
        } else {
            self.sample_diffuse(meeting, [u[1], u[2]])
        };
        let pdf = self.pdf(meeting, sky, direction);
        (pdf.is_finite() && pdf > 0.0).then_some((direction, pdf))
    }

    /// Density per steradian of [`Material::sample`].
    fn pdf(&self, meeting: &Meeting, sky: &Sky, direction: DVec3) -> f64 {
        let [highlight, of_sky, diffuse] = self.shares(sky);
        let mut sum = 0.0;
        if let (Highlight::Physical(fiber), true) = (&self.highlight, highlight > 0.0) {
            let theta_i = longitudinal_angle(meeting.tangent, direction);
            let theta_o = longitudinal_angle(meeting.tangent, meeting.to_eye);
            let [u, v] = across(meeting);
            let phi = angle_of(direction.dot(v), direction.dot(u));
            sum += highlight * sample::pdf(theta_i, theta_o, phi, fiber);
        }
        if of_sky > 0.0 {
            sum += of_sky * sky.pdf(direction);
        }
        // Light from behind matters to the simple highlight too: a part goes everywhere alike.
        let [around, everywhere] = self.diffuse_shares();
        let cosine = meeting.normal.dot(direction).max(0.0);
        sum + diffuse * (around * cosine / PI + everywhere / (4.0 * PI))
    }

    /// Of draws from the diffuse lobe: those by its cosine, and those from everywhere for the simple highlight.
    fn diffuse_shares(&self) -> [f64; 2] {
        if matches!(self.highlight, Highlight::Simple(..)) { [0.5, 0.5] } else { [1.0, 0.0] }
    }

    fn sample_diffuse(&self, meeting: &Meeting, u: [f64; 2]) -> DVec3 {
        let [around, _] = self.diffuse_shares();
        let n = meeting.normal;
        let (a, b) = (meeting.tangent, n.cross(meeting.tangent));
        let (z, azimuth) = if u[0] < around {
            ((1.0 - u[0] / around).sqrt(), u[1])
        } else {
            (1.0 - 2.0 * (u[0] - around) / (1.0 - around), u[1])
        };
        let (s, c) = (TAU * azimuth).sin_cos();
        z * n + (1.0 - z * z).max(0.0).sqrt() * (c * a + s * b)
    }

    fn sample_highlight(&self, meeting: &Meeting, u: [f64; 3]) -> Option<DVec3> {
        let Highlight::Physical(fiber) = &self.highlight else { return None };
        let theta_o = longitudinal_angle(meeting.tangent, meeting.to_eye);
        let Sample { theta_i, phi, .. } = sample::sample(theta_o, fiber, u);
        let [x, y] = across(meeting);
        let (s, c) = phi.sin_cos();
        // The cosine of an angle next to the pole, without the difference.
        let cosine = (FRAC_PI_2 - theta_i.abs()).max(0.0).sin();
        Some(theta_i.sin() * meeting.tangent + cosine * (c * x + s * y))
    }
}

/// Where azimuths are measured from: the eye's, and a quarter turn on.
fn across(meeting: &Meeting) -> [DVec3; 2] {
    let x = normal_perpendicular_to(meeting.tangent, meeting.to_eye);
    [x, meeting.tangent.cross(x)]
}

#[cfg(test)]
#[path = "material_tests.rs"]
mod tests;
