#pragma once

#include <Inventor/nodes/SoShape.h>
#include <Inventor/nodes/SoSubNode.h>

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "beltgrinding/geometry.h"
#include "coin/triangle_picker.h"

namespace beltgrinding {

/// A Coin node that draws a height field: one vertex and one colour or value a sample, from vertex
/// buffers of which only what has changed is sent to the graphics card. Values are coloured by a
/// palette at every pixel, so that a border between two colours runs through the triangles. Lit or
/// flat by the SoLightModel before it; seen from both sides by the SoShapeHints. A pick gives an
/// SoFaceDetail whose point details hold the samples at the triangle's corners. Lengths in mm,
/// frame: work.
///
/// All members belong to the thread that draws.
class SoHeightField : public SoShape {
    SO_NODE_HEADER(SoHeightField);

  public:
    /// Registers the type with Coin; again is harmless. Coin must have been started.
    static void initClass();
    /// The node at an address that came through Python; null if there is none.
    static SoHeightField* at(std::uintptr_t address);

    SoHeightField();

    /// What stays: design points (n x 3), outward normals or, where samples lean, rays (n x 3),
    /// triangles between samples.
    /// Heights are 0 and colours grey afterwards. Throws InputError if the lengths do not fit or a
    /// triangle names a sample that is not there.
    void setSamples(std::span<const double> points, std::span<const float> normals,
                    std::span<const std::uint32_t> triangles);
    /// Heights along the normals, one a sample. Throws InputError for a wrong number.
    void setHeights(std::span<const double> heights);
    /// One colour 0xRRGGBBAA a sample; drawn opaque. Throws InputError for a wrong number.
    void setColours(std::span<const std::uint32_t> colours);
    /// One value a sample in place of its colour: `palette` (0xRRGGBBAA, at most 4096) spans
    /// [low, high], beyond which its ends go on; where a value is NaN, `missing` is drawn. Throws
    /// InputError for a wrong number or an empty range.
    void setValues(std::span<const double> values, double low, double high,
                   std::span<const std::uint32_t> palette, std::uint32_t missing);
    std::size_t size() const { return points_.size(); }

    void GLRender(SoGLRenderAction* action) override;
    void rayPick(SoRayPickAction* action) override;
    void getPrimitiveCount(SoGetPrimitiveCountAction* action) override;

  protected:
    ~SoHeightField() override;
    void generatePrimitives(SoAction* action) override;
    void computeBBox(SoAction* action, SbBox3f& box, SbVec3f& centre) override;

  private:
    /// What a context's buffer lacks: elements [begin, end); `all`: it must be made anew.
    struct Stale {
        std::size_t begin = 0, end = 0;
        bool all = true;
        void add(std::size_t from, std::size_t to);
    };
    /// The buffers of one GL context (several views share one, or do not).
    struct Buffers {
        unsigned vertex = 0, normal = 0, colour = 0, value = 0, index = 0, texture = 0;
        Stale vertices, normals, colours, values, indices;
        bool palette_stale = true;
    };

    Buffers& buffers(const void* glue, std::uint32_t context);
    void bindPalette(Buffers& b);
    static void contextDestroyed(std::uint32_t context, void* self);
    SoDetail* detail(const TriangleHit& hit) const;

    std::vector<Vec3> points_;
    std::vector<Vec3f> normals_;
    std::vector<Vec3f> vertices_;
    std::vector<double> heights_;
    std::vector<std::uint32_t> colours_;  // bytes in the order r g b a
    /// Texture coordinates: where in the palette, and in what row; empty: colours are drawn.
    std::vector<std::array<float, 2>> values_;
    std::vector<std::uint32_t> palette_;  // two rows of bytes r g b a: values, missing ones
    std::vector<Triangle> triangles_;
    Eigen::AlignedBox3f box_;
    TrianglePicker picker_;
    bool picker_stale_ = true;
    std::map<std::uint32_t, Buffers> buffers_;
};

}  // namespace beltgrinding
