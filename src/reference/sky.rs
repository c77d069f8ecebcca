//! Light from everywhere: the same, or a picture of it, looked up and drawn by its own brightness.

use crate::scene::Scene;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Light from everywhere.
pub struct Sky {
    constant: DVec3,
    picture: Option<Picture>,
}

/// A latitude-longitude picture: row 0 up, its middle toward -Z, columns toward +X. Every pixel is one radiance
/// over its own solid angle.
struct Picture {
    width: usize,
    height: usize,
    pixels: Vec<DVec3>,
    yaw: f64,
    /// Share of the picture's brightness up to and with each pixel, in rows; the last is 1.
    shares: Vec<f64>,
}

impl Sky {
    /// What the scene says of it; black where shading leaves it out.
    pub fn new(scene: &Scene) -> Self {
        let ambient = &scene.file.ambient;
        if !scene.file.shading.ambient {
            return Self { constant: DVec3::ZERO, picture: None };
        }
        let picture = scene.environment.as_deref().map(|image| {
            let radiance = |&[r, g, b, _]: &[f32; 4]| DVec3::new(r.into(), g.into(), b.into());
            let pixels = image.pixels.iter().map(|p| ambient.environment_scale * radiance(p)).collect();
            let size = [image.width as usize, image.height as usize];
            Picture::new(pixels, size, ambient.environment_yaw_deg.to_radians())
        });
        Self { constant: ambient.radiance(), picture }
    }

    /// Whether no light comes from anywhere.
    pub fn is_black(&self) -> bool {
        self.constant == DVec3::ZERO && self.picture.as_ref().is_none_or(|p| p.shares.is_empty())
    }

    /// Radiance from a unit direction.
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        match &self.picture {
            Some(picture) => picture.pixels[picture.pixel_of(direction)],
            None => self.constant,
        }
    }

    /// A direction in proportion to brightness, from three uniform numbers in [0, 1); `None` where the same comes
    /// from everywhere, or nothing.
    pub fn sample(&self, u: [f64; 3]) -> Option<DVec3> {
        let picture = self.picture.as_ref()?;
        let index = picture.shares.partition_point(|share| *share <= u[0]);
        (index < picture.shares.len()).then(|| picture.direction(index, [u[1], u[2]]))
    }

    /// Density per steradian with which [`Sky::sample`] draws a direction.
    pub fn pdf(&self, direction: DVec3) -> f64 {
        let Some(picture) = self.picture.as_ref().filter(|p| !p.shares.is_empty()) else { return 0.0 };
        let index = picture.pixel_of(direction);
        let before = if index > 0 { picture.shares[index - 1] } else { 0.0 };
        (picture.shares[index] - before) / picture.solid_angle(index / picture.width)
    }
}

impl Picture {
    fn new(pixels: Vec<DVec3>, [width, height]: [usize; 2], yaw: f64) -> Self {
        let mut picture = Self { width, height, pixels, yaw, shares: Vec::new() };
        let mut sum = 0.0;
        let weigh = |(index, pixel): (usize, &DVec3)| {
            sum += pixel.element_sum() * picture.solid_angle(index / width);
            sum
        };
        let mut shares: Vec<f64> = picture.pixels.iter().enumerate().map(weigh).collect();
        if sum > 0.0 {
            shares.iter_mut().for_each(|share| *share /= sum);
            picture.shares = shares;
        }
        picture
    }

    fn row_cosine(&self, row: usize) -> f64 {
        (PI * row as f64 / self.height as f64).cos()
    }

    fn solid_angle(&self, row: usize) -> f64 {
        (self.row_cosine(row) - self.row_cosine(row + 1)) * TAU / self.width as f64
    }

    fn pixel_of(&self, direction: DVec3) -> usize {
        let turns = (direction.x.atan2(-direction.z) + self.yaw) / TAU + 0.5;
        let column = (turns.rem_euclid(1.0) * self.width as f64) as usize;
        let angle = direction.y.clamp(-1.0, 1.0).acos();
        let row = (angle / PI * self.height as f64) as usize;
        row.min(self.height - 1) * self.width + column.min(self.width - 1)
    }

    /// A direction in the pixel, uniform in solid angle.
    fn direction(&self, index: usize, u: [f64; 2]) -> DVec3 {
        let (row, column) = (index / self.width, index % self.width);
        let azimuth = TAU * ((column as f64 + u[0]) / self.width as f64 - 0.5) - self.yaw;
        let (high, low) = (self.row_cosine(row), self.row_cosine(row + 1));
        let y = high + (low - high) * u[1];
        let across = (1.0 - y * y).max(0.0).sqrt();
        DVec3::new(across * azimuth.sin(), y, -across * azimuth.cos())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::picture::LinearImage;
    use crate::math::rng::Rng;
    use crate::reference::test_scene::{scene_of, straight, yarn};
    use std::sync::Arc;

    fn sky(yaw_deg: f64) -> Sky {
        let text = format!("[ambient]\nenvironment = 'sky.exr'\nenvironment_yaw_deg = {yaw_deg}");
        let mut scene = scene_of(&text, &[straight(0.0, 1.0, 0.0)], &yarn("cotton1", 1));
        let mut image = LinearImage::filled(16, 8, [0.1, 0.2, 0.3, 1.0]);
        // The middle of the upper half, toward -Z, and a dark one.
        image.pixels[2 * 16 + 8] = [9.0, 0.0, 0.0, 1.0];
        image.pixels[5] = [0.0, 0.0, 0.0, 1.0];
        scene.environment = Some(Arc::new(image));
        Sky::new(&scene)
    }

    #[test]
    fn the_picture_s_middle_is_ahead_of_a_camera_with_its_yaw() {
        let ahead = DVec3::new(0.02, 0.5, -1.0).normalize();
        assert_eq!(sky(0.0).radiance(ahead).x, 9.0);
        assert_eq!(sky(0.0).radiance(-ahead).x, f64::from(0.1f32));
        // A camera turned by 90 degrees looks along -X.
        assert_eq!(sky(90.0).radiance(DVec3::new(-1.0, 0.5, -0.02).normalize()).x, 9.0);
    }

    #[test]
    fn directions_are_drawn_with_their_density_and_integrate_the_picture() {
        let sky = sky(30.0);
        let (mut sum, mut exact) = (DVec3::ZERO, DVec3::ZERO);
        let count = 200_000;
        for k in 0..count {
            let mut rng = Rng::new(2, &[k]);
            let mut u = || rng.uniform();
            let direction = sky.sample([u(), u(), u()]).unwrap();
            assert!(direction.is_normalized() && sky.pdf(direction) > 0.0);
            sum += sky.radiance(direction) / sky.pdf(direction) / count as f64;
            // Uniform over the sphere.
            let (y, azimuth) = (2.0 * u() - 1.0, TAU * u());
            let across = (1.0 - y * y).sqrt();
            let uniform = DVec3::new(across * azimuth.cos(), y, across * azimuth.sin());
            exact += sky.radiance(uniform) * 4.0 * PI / count as f64;
        }
        assert!((sum / exact - 1.0).abs().max_element() < 0.05, "{sum} {exact}");
        let dark = sky.picture.as_ref().unwrap().direction(5, [0.5, 0.5]);
        assert_eq!(sky.pdf(dark), 0.0);
    }

    #[test]
    fn shading_without_ambient_is_black_and_constant_light_has_no_picture() {
        let at = |text: &str| Sky::new(&scene_of(text, &[straight(0.0, 1.0, 0.0)], &yarn("cotton1", 1)));
        assert!(
            at("[shading]\nambient = false").is_black() && at("[ambient]\nradiance = [0, 0, 0]").is_black()
        );
        let constant = at("[ambient]\nradiance = [1, 2, 3]");
        assert!(!constant.is_black() && constant.sample([0.5; 3]).is_none());
        assert_eq!(constant.radiance(DVec3::X), DVec3::new(1.0, 2.0, 3.0));
    }
}
