// SPDX-License-Identifier: Apache-2.0
/// Lighting of a Lambertian surface by real spherical harmonics up to order 2: nine coefficients per colour.
///
/// Basis, of a unit vector n = (x, y, z), in the order (l, m) = 00, 1−1, 10, 11, 2−2, 2−1, 20, 21, 22:
///   Y = [ 0.282095, 0.488603 y, 0.488603 z, 0.488603 x,
///         1.092548 xy, 1.092548 yz, 0.315392 (3z² − 1), 1.092548 xz, 0.546274 (x² − y²) ]
/// with ½√(1/π), ½√(3/π), ½√(15/π), ¼√(5/π), ¼√(15/π): orthonormal over the sphere.
///
/// With L(ω) the incident radiance from direction ω, L_k = ∫ L Y_k dω its coefficients,
///   shading(n) = E(n)/π = 1/π ∫ L(ω) max(0, n·ω) dω ≈ Σ_k (A_l/π) L_k Y_k(n),     A = π, 2π/3, π/4
/// (Ramamoorthi & Hanrahan, "An efficient representation for irradiance environment maps", SIGGRAPH 2001). Divided by
/// π, so that a Lambertian surface of albedo a has radiance a · shading, and uniform radiance 1 gives shading 1. The
/// error is that of orders 4, 6, …: for a directional light at most 3/32 of its strength (at n·ω = 0; 1/16 at n = ±ω).
///
/// Frame: that of the normals. Renderers use the camera frame (x right, y down, z forward); lights are given in the
/// viewer's axes (x right, y up, z towards the viewer), see CameraFromViewer.
#pragma once

#include <Eigen/Core>
#include <span>

#include "render/image/image.h"

namespace bodyloom {

using ShVector = Eigen::Matrix<double, 9, 1>;
/// Rows red, green, blue; columns as the basis, lobes A_l/π included: shading = lighting · ShBasis(n).
using ShLighting = Eigen::Matrix<double, 3, 9>;

/// Y(n). n should have length 1; not checked.
ShVector ShBasis(const Eigen::Vector3d& n);

/// Red, green, blue of the shading at a unit normal; may be slightly negative on the side turned away from the light.
inline Eigen::Vector3d Shading(const ShLighting& lighting, const Eigen::Vector3d& n) { return lighting * ShBasis(n); }

/// Uniform light: shading(n) = colour.
ShLighting AmbientLight(const Eigen::Vector3d& colour);
/// One colour of AmbientLight({1, 1, 1}).
ShVector EvenLight();
/// The same coefficients for all three colours.
inline ShLighting GreyLight(const ShVector& coefficients) { return Eigen::Vector3d::Ones() * coefficients.transpose(); }

/// Luminance: 0.2126 red + 0.7152 green + 0.0722 blue (ITU-R BT.709).
double LuminanceOf(const Eigen::Vector3d& light);

/// A light infinitely far away in the direction `towards_light` (any length but 0, std::invalid_argument otherwise):
/// shading(n) ≈ colour · max(0, n · towards_light).
ShLighting DirectionalLight(const Eigen::Vector3d& towards_light, const Eigen::Vector3d& colour);

/// Encoding of light as pixel values: IEC 61966-2-1 with its exponent 2.4, or linear.
enum class PixelEncoding { kSrgb, kLinear };
/// Light in [0, 1] of a value in [0, 1], and back. Values outside are clamped first.
double DecodePixel(double value, PixelEncoding encoding);
double EncodePixel(double light, PixelEncoding encoding);

/// Lighting by an environment, an equirectangular image around the person, white being radiance 1. Rows run from
/// straight up to straight down; the middle column is straight ahead of the camera (behind the person), columns
/// to the right of it lie to the camera's right, and the outermost ones behind the camera. Pixels are weighted by their
/// solid angle. Result in the camera frame. Throws std::invalid_argument for an empty image.
ShLighting EnvironmentLight(const Image& equirectangular, PixelEncoding encoding);

/// Viewer's axes (x right, y up, z towards the viewer) to the camera frame and back: (x, −y, −z).
inline Eigen::Vector3d CameraFromViewer(const Eigen::Vector3d& v) { return {v.x(), -v.y(), -v.z()}; }

// Relights a person by surface normals with the ratio image
//   relit = light · clamp( max(S_new(n), ε) / max(S_old(n), ε) ),     S: shading
// per colour, on linear light. Exact for Lambertian surfaces without cast shadows; albedo cancels out, so no texture
// model is needed. Shadows and highlights in the image stay.

struct RelightOptions {
  PixelEncoding encoding = PixelEncoding::kSrgb;
  double min_shading = 0.05;       ///< ε
  double max_ratio = 4;            ///< brightening beyond this would amplify the noise of dark pixels
  double min_normal_length = 0.3;  ///< pixels whose normal divided by alpha is shorter than this stay
};

/// `image` (3 planes RGB in [0, 1], multiplied by alpha) of `alpha.size()` pixels with `normals` (3 planes, camera
/// frame, shortened by alpha) is relit in place. Pixels with alpha below 1/255 stay. Throws std::invalid_argument when
/// sizes do not fit or an option is not positive.
void Relight(const ShLighting& old_light, const ShLighting& new_light, std::span<const float> normals,
             std::span<const float> alpha, const RelightOptions& options, std::span<float> image);

}  // namespace bodyloom
