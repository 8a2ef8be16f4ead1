#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "beltgrinding/geometry.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// Triangles with colours, to be drawn. Frame: any, the same for all surfaces of a picture; mm.
struct ColouredSurface {
    std::vector<Vec3> vertices;          ///< mm
    std::vector<Triangle> triangles;     ///< of vertices; either side may face the camera
    std::vector<Vec3f> normals;          ///< unit, one a vertex, for the light; empty: the facets'
    std::vector<std::uint32_t> colours;  ///< 0xRRGGBBAA (alpha unused), one a vertex or one for all
};

/// An orthographic camera, in the surfaces' frame.
struct Camera {
    Vec3 target = Vec3::Zero();      ///< mm, in the middle of the picture
    Vec3 direction{0.0, 0.0, -1.0};  ///< in which one looks
    Vec3 up{0.0, 1.0, 0.0};          ///< what points up in the picture; not along `direction`
    double height = 100.0;           ///< mm from the picture's lower to its upper border
    /// mm before the target's plane from which on things are seen: what stands in front is cut
    /// away.
    double near = std::numeric_limits<double>::infinity();
};

/// Rows from the top, pixels from the left.
struct Picture {
    std::size_t width = 0, height = 0;  ///< pixels
    std::vector<std::uint8_t> rgb;      ///< three bytes a pixel, sRGB
    std::vector<float> depth;  ///< mm beyond the target's plane in the pixel's middle; NaN: nothing
};

/// Pictures of surfaces by a rasteriser of our own, without a display: two-sided Lambert light from
/// the camera's upper left with an ambient share, four rays a pixel, outlines drawn where the depth
/// jumps or the surface has a crease. The pixels do not depend on the number of threads.
class Renderer {
  public:
    /// Throws InputError for a vertex that is not finite, an index or a number of colours or
    /// normals that does not fit, or nothing to be drawn.
    explicit Renderer(std::vector<ColouredSurface> surfaces, const RunContext& context = {});
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// Extents of all vertices, mm.
    const Box& extents() const;

    /// Draws `width` x `height` pixels on white. Throws InputError for a camera whose vectors span
    /// no picture, or a size of none or beyond 8192 pixels.
    Picture render(const Camera& camera, std::size_t width, std::size_t height,
                   const RunContext& context = {}) const;

    /// Lines of sight: 1 at [p * directions.size() + d] where nothing stands between `points[p]`
    /// and a camera far away in `directions[d]` (not zero, any length), else 0. What lies within
    /// `slack` mm of a point does not hide it. `asked`, if not empty, has the same places: 0 where
    /// the answer is not needed; it is 0 then.
    std::vector<std::uint8_t> seen(const std::vector<Vec3>& points,
                                   const std::vector<Vec3>& directions, double slack,
                                   std::span<const std::uint8_t> asked = {}) const;

    /// Of all vertices those that lie farthest along each direction, and against it; each once, in
    /// the surfaces' order.
    std::vector<Vec3> farthest(const std::vector<Vec3>& directions) const;

  private:
    struct Scene;
    std::unique_ptr<Scene> scene_;
};

}  // namespace beltgrinding
