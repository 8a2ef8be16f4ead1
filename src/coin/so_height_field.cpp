#include "coin/so_height_field.h"

#include <Inventor/C/glue/gl.h>
#include <Inventor/SbLine.h>
#include <Inventor/SoPickedPoint.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/bundles/SoMaterialBundle.h>
#include <Inventor/details/SoFaceDetail.h>
#include <Inventor/details/SoPointDetail.h>
#include <Inventor/elements/SoCacheElement.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/elements/SoGLLazyElement.h>
#include <Inventor/misc/SoContextHandler.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <set>
#include <string>

#include "base/parallel.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kBlock = 16384;       // samples of one task
constexpr std::size_t kMostColours = 4096;  // of a palette: every GL takes such a texture
constexpr float kKnownRow = 0.25F, kMissingRow = 0.75F;  // middles of the texture's rows
constexpr std::uint32_t kUncoloured = 0xFFB0B0B0;        // grey, until colours are set

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Vec3f) == 3 * sizeof(float));

std::set<const SoHeightField*>& living() {
    static std::set<const SoHeightField*> nodes;
    return nodes;
}

/// Calls `body` for blocks of [0, n).
template <class Body>
void blocks(std::size_t n, Body&& body) {
    parallel_blocks(n, kBlock, RunContext(), body);
}

std::size_t block_count(std::size_t n) {
    return (n + kBlock - 1) / kBlock;
}

void check_length(std::size_t given, std::size_t expected, const char* what) {
    if (given != expected) {
        throw InputError("coin.length", "{name}: {given} values given, {needed} needed",
                         {{"name", what}, {"given", given}, {"needed", expected}});
    }
}

SbVec3f to_coin(const Vec3f& v) {
    return {v.x(), v.y(), v.z()};
}

/// 0xRRGGBBAA as four opaque bytes r g b a.
std::uint32_t bytes_of(std::uint32_t colour) {
    const std::uint32_t c = colour | 255U;
    if constexpr (std::endian::native == std::endian::little)
        return c >> 24U | (c >> 8U & 0xFF00U) | (c << 8U & 0xFF0000U) | c << 24U;
    return c;
}

/// Names of buffers and of a texture that can only be deleted when their context is current again.
struct Orphans {
    std::array<GLuint, 5> names;
    GLuint texture;
};

void delete_orphans(void* closure, std::uint32_t context) {
    auto* orphans = static_cast<Orphans*>(closure);
    cc_glglue_glDeleteBuffers(cc_glglue_instance(static_cast<int>(context)),
                              static_cast<GLsizei>(orphans->names.size()), orphans->names.data());
    if (orphans->texture != 0) glDeleteTextures(1, &orphans->texture);
    delete orphans;
}

/// Binds `buffer` and sends it the elements that it lacks.
template <class T, class Stale>
void send(const cc_glglue* glue, GLenum target, GLuint buffer, const std::vector<T>& data,
          Stale& stale) {
    cc_glglue_glBindBuffer(glue, target, buffer);
    if (stale.all) {
        cc_glglue_glBufferData(glue, target, static_cast<intptr_t>(data.size() * sizeof(T)),
                               data.data(), GL_DYNAMIC_DRAW);
    } else if (stale.begin < stale.end) {
        cc_glglue_glBufferSubData(glue, target, static_cast<intptr_t>(stale.begin * sizeof(T)),
                                  static_cast<intptr_t>((stale.end - stale.begin) * sizeof(T)),
                                  data.data() + stale.begin);
    }
    stale.all = false;
    stale.begin = stale.end = 0;
}

}  // namespace

SO_NODE_SOURCE(SoHeightField)

void SoHeightField::initClass() {
    if (getClassTypeId().isBad()) SO_NODE_INIT_CLASS(SoHeightField, SoShape, "Shape");
}

SoHeightField* SoHeightField::at(std::uintptr_t address) {
    // pivy hands nodes over as numbers. NOLINTNEXTLINE(performance-no-int-to-ptr)
    auto* node = reinterpret_cast<SoHeightField*>(address);
    return living().contains(node) ? node : nullptr;
}

SoHeightField::SoHeightField() {
    SO_NODE_CONSTRUCTOR(SoHeightField);
    living().insert(this);
    SoContextHandler::addContextDestructionCallback(contextDestroyed, this);
}

SoHeightField::~SoHeightField() {
    living().erase(this);
    SoContextHandler::removeContextDestructionCallback(contextDestroyed, this);
    for (const auto& [context, b] : buffers_) {
        // Out of memory, nothing would be left to do.
        // NOLINTNEXTLINE(bugprone-unhandled-exception-at-new)
        auto* orphans = new Orphans{{b.vertex, b.normal, b.colour, b.value, b.index}, b.texture};
        SoGLCacheContextElement::scheduleDeleteCallback(context, delete_orphans, orphans);
    }
}

void SoHeightField::Stale::add(std::size_t from, std::size_t to) {
    if (from >= to) return;
    begin = begin < end ? std::min(begin, from) : from;
    end = std::max(end, to);
}

void SoHeightField::setSamples(std::span<const double> points, std::span<const float> normals,
                               std::span<const std::uint32_t> triangles) {
    const std::size_t n = points.size() / 3;
    check_length(points.size(), 3 * n, "points");
    check_length(normals.size(), 3 * n, "normals");
    check_length(triangles.size(), triangles.size() / 3 * 3, "triangles");
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (triangles[i] >= n) {
            throw InputError("coin.triangle_without_sample",
                             "triangle {triangle} names sample {sample}, but there are {count}",
                             {{"triangle", i / 3}, {"sample", triangles[i]}, {"count", n}});
        }
    }
    points_.resize(n);
    normals_.resize(n);
    triangles_.resize(triangles.size() / 3);
    if (n != 0) {
        std::memcpy(points_.data()->data(), points.data(), points.size_bytes());
        std::memcpy(normals_.data()->data(), normals.data(), normals.size_bytes());
    }
    if (!triangles_.empty()) {
        std::memcpy(triangles_.data()->data(), triangles.data(), triangles.size_bytes());
    }
    vertices_.assign(n, Vec3f::Zero());
    colours_.assign(n, kUncoloured);
    heights_.clear();
    values_.clear();
    for (auto& [context, b] : buffers_) {
        b.vertices.all = b.normals.all = b.colours.all = b.values.all = b.indices.all = true;
    }
    setHeights(std::vector<double>(n, 0.0));
}

void SoHeightField::setHeights(std::span<const double> heights) {
    const std::size_t n = size();
    check_length(heights.size(), n, "heights");
    const bool fresh = heights_.size() != n;
    if (fresh) heights_.assign(n, 0.0);
    struct Block {
        std::size_t first = 0, last = 0;
        Eigen::AlignedBox3f box;
    };
    std::vector<Block> done(block_count(n));
    blocks(n, [&](std::size_t begin, std::size_t end) {
        Block& block = done[begin / kBlock];
        for (std::size_t i = begin; i < end; ++i) {
            if (fresh || heights_[i] != heights[i]) {
                heights_[i] = heights[i];
                vertices_[i] = (points_[i] + heights[i] * normals_[i].cast<double>()).cast<float>();
                if (block.first == block.last) block.first = i;
                block.last = i + 1;
            }
            block.box.extend(vertices_[i]);
        }
    });
    box_.setEmpty();
    Stale changed;
    for (const Block& block : done) {
        changed.add(block.first, block.last);
        box_.extend(block.box);
    }
    if (changed.begin == changed.end) return;
    for (auto& [context, b] : buffers_) b.vertices.add(changed.begin, changed.end);
    picker_stale_ = true;
    touch();
}

void SoHeightField::setColours(std::span<const std::uint32_t> colours) {
    const std::size_t n = size();
    check_length(colours.size(), n, "colours");
    std::vector<std::pair<std::size_t, std::size_t>> done(block_count(n), {0, 0});
    blocks(n, [&](std::size_t begin, std::size_t end) {
        auto& [first, last] = done[begin / kBlock];
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t bytes = bytes_of(colours[i]);
            if (colours_[i] == bytes) continue;
            colours_[i] = bytes;
            if (first == last) first = i;
            last = i + 1;
        }
    });
    Stale changed;
    for (const auto& [first, last] : done) changed.add(first, last);
    if (changed.begin == changed.end && values_.empty()) return;
    values_.clear();
    for (auto& [context, b] : buffers_) {
        b.colours.add(changed.begin, changed.end);
        b.values.all = true;
    }
    touch();
}

void SoHeightField::setValues(std::span<const double> values, double low, double high,
                              std::span<const std::uint32_t> palette, std::uint32_t missing) {
    const std::size_t n = size();
    check_length(values.size(), n, "values");
    if (!(low < high) || !std::isfinite(high - low) || palette.empty() ||
        palette.size() > kMostColours) {
        throw InputError("coin.palette",
                         "a palette has 1 to {most} colours and spans a range of values",
                         {{"most", kMostColours}});
    }
    const bool fresh = values_.size() != n;
    values_.resize(n);
    std::vector<std::pair<std::size_t, std::size_t>> done(block_count(n), {0, 0});
    blocks(n, [&](std::size_t begin, std::size_t end) {
        auto& [first, last] = done[begin / kBlock];
        for (std::size_t i = begin; i < end; ++i) {
            const bool known = !std::isnan(values[i]);
            const auto share = known ? static_cast<float>((values[i] - low) / (high - low)) : 0.0F;
            const std::array<float, 2> at{share, known ? kKnownRow : kMissingRow};
            if (!fresh && values_[i] == at) continue;
            values_[i] = at;
            if (first == last) first = i;
            last = i + 1;
        }
    });
    std::vector<std::uint32_t> rows;
    rows.reserve(2 * palette.size());
    for (const std::uint32_t colour : palette) rows.push_back(bytes_of(colour));
    rows.resize(2 * palette.size(), bytes_of(missing));
    const bool recoloured = rows != palette_;
    palette_ = std::move(rows);
    Stale changed;
    for (const auto& [first, last] : done) changed.add(first, last);
    if (changed.begin == changed.end && !recoloured) return;
    for (auto& [context, b] : buffers_) {
        b.values.add(changed.begin, changed.end);
        b.values.all = b.values.all || fresh;
        b.palette_stale = b.palette_stale || recoloured;
    }
    touch();
}

SoHeightField::Buffers& SoHeightField::buffers(const void* glue, std::uint32_t context) {
    const auto [it, is_new] = buffers_.try_emplace(context);
    if (is_new) {
        std::array<GLuint, 5> names{};
        cc_glglue_glGenBuffers(static_cast<const cc_glglue*>(glue),
                               static_cast<GLsizei>(names.size()), names.data());
        Buffers& b = it->second;
        b.vertex = names[0], b.normal = names[1], b.colour = names[2];
        b.value = names[3], b.index = names[4];
    }
    return it->second;
}

void SoHeightField::contextDestroyed(std::uint32_t context, void* self) {
    // The buffers go with their context.
    static_cast<SoHeightField*>(self)->buffers_.erase(context);
}

void SoHeightField::bindPalette(Buffers& b) {
    if (b.texture == 0) glGenTextures(1, &b.texture);
    glBindTexture(GL_TEXTURE_2D, b.texture);
    if (b.palette_stale) {
        // Nearest: a mean of two colours would stand for a value that is not there.
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, static_cast<GLsizei>(palette_.size() / 2), 2, 0,
                     GL_RGBA, GL_UNSIGNED_BYTE, palette_.data());
        b.palette_stale = false;
    }
    glEnable(GL_TEXTURE_2D);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
}

void SoHeightField::GLRender(SoGLRenderAction* action) {
    if (triangles_.empty() || !shouldGLRender(action)) return;
    SoState* state = action->getState();
    // A display list would keep a copy of the buffers and draw it after the next change.
    SoCacheElement::invalidate(state);
    SoGLCacheContextElement::shouldAutoCache(state, SoGLCacheContextElement::DONT_AUTO_CACHE);
    SoMaterialBundle material(action);
    material.sendFirst();

    const auto context = static_cast<std::uint32_t>(SoGLCacheContextElement::get(state));
    const cc_glglue* glue = cc_glglue_instance(static_cast<int>(context));
    const bool buffered = cc_glglue_has_vertex_buffer_object(glue) != 0;
    const void *vertices = nullptr, *normals = nullptr, *colours = nullptr, *indices = nullptr;
    const bool by_value = !values_.empty();
    glPushAttrib(GL_LIGHTING_BIT | GL_CURRENT_BIT | GL_TEXTURE_BIT | GL_ENABLE_BIT);
    glPushClientAttrib(GL_CLIENT_VERTEX_ARRAY_BIT | GL_CLIENT_PIXEL_STORE_BIT);
    glColorMaterial(GL_FRONT_AND_BACK, GL_DIFFUSE);
    glEnable(GL_COLOR_MATERIAL);
    // With a buffer bound, a pointer is an offset into it.
    Buffers* b = nullptr;
    Buffers unbuffered;  // keeps the palette's texture for this once
    if (buffered) {
        b = &buffers(glue, context);
        send(glue, GL_ARRAY_BUFFER, b->vertex, vertices_, b->vertices);
    } else {
        vertices = vertices_.data(), normals = normals_.data();
        colours = by_value ? static_cast<const void*>(values_.data()) : colours_.data();
        indices = triangles_.data();
    }
    glVertexPointer(3, GL_FLOAT, 0, vertices);
    if (b != nullptr) send(glue, GL_ARRAY_BUFFER, b->normal, normals_, b->normals);
    glNormalPointer(GL_FLOAT, 0, normals);
    if (by_value) {
        if (b != nullptr) send(glue, GL_ARRAY_BUFFER, b->value, values_, b->values);
        glTexCoordPointer(2, GL_FLOAT, 0, colours);
        bindPalette(b != nullptr ? *b : unbuffered);
    } else {
        if (b != nullptr) send(glue, GL_ARRAY_BUFFER, b->colour, colours_, b->colours);
        glColorPointer(4, GL_UNSIGNED_BYTE, 0, colours);
    }
    if (b != nullptr) send(glue, GL_ELEMENT_ARRAY_BUFFER, b->index, triangles_, b->indices);
    const GLenum coloured = by_value ? GL_TEXTURE_COORD_ARRAY : GL_COLOR_ARRAY;
    for (const GLenum array : {GLenum{GL_VERTEX_ARRAY}, GLenum{GL_NORMAL_ARRAY}, coloured})
        glEnableClientState(array);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * triangles_.size()), GL_UNSIGNED_INT,
                   indices);
    if (b != nullptr) {
        cc_glglue_glBindBuffer(glue, GL_ARRAY_BUFFER, 0);
        cc_glglue_glBindBuffer(glue, GL_ELEMENT_ARRAY_BUFFER, 0);
    }
    glPopClientAttrib();
    glPopAttrib();
    if (unbuffered.texture != 0) glDeleteTextures(1, &unbuffered.texture);
    SoGLLazyElement::getInstance(state)->reset(state, SoLazyElement::DIFFUSE_MASK);
}

SoDetail* SoHeightField::detail(const TriangleHit& hit) const {
    auto* face = new SoFaceDetail;
    face->setFaceIndex(static_cast<int>(hit.triangle));
    face->setNumPoints(3);
    for (int k = 0; k < 3; ++k) {
        SoPointDetail corner;
        corner.setCoordinateIndex(static_cast<int>(triangles_[hit.triangle][k]));
        face->setPoint(k, &corner);
    }
    return face;
}

void SoHeightField::rayPick(SoRayPickAction* action) {
    if (triangles_.empty() || !shouldRayPick(action)) return;
    action->setObjectSpace();
    if (picker_stale_) {
        picker_.update(vertices_, triangles_);
        picker_stale_ = false;
    }
    const SbLine& line = action->getLine();
    const SbVec3f o = line.getPosition(), d = line.getDirection();
    for (const TriangleHit& hit :
         picker_.pick(vertices_, triangles_, {o[0], o[1], o[2]}, {d[0], d[1], d[2]})) {
        const Triangle& t = triangles_[hit.triangle];
        Vec3f at = Vec3f::Zero(), normal = Vec3f::Zero();
        for (int k = 0; k < 3; ++k) {
            at += hit.weights[k] * vertices_[t[k]];
            normal += hit.weights[k] * normals_[t[k]];
        }
        if (!action->isBetweenPlanes(to_coin(at))) continue;
        // Null where something nearer is picked already.
        if (SoPickedPoint* picked = action->addIntersection(to_coin(at))) {
            picked->setDetail(detail(hit), this);
            picked->setObjectNormal(to_coin(normal.normalized()));
        }
    }
}

void SoHeightField::getPrimitiveCount(SoGetPrimitiveCountAction* action) {
    if (shouldPrimitiveCount(action)) action->addNumTriangles(static_cast<int>(triangles_.size()));
}

void SoHeightField::generatePrimitives(SoAction* action) {
    SoPointDetail corner;
    SoFaceDetail face;
    beginShape(action, TRIANGLES, &face);
    for (const auto& triangle : triangles_) {
        for (const std::uint32_t v : triangle) {
            corner.setCoordinateIndex(static_cast<int>(v));
            SoPrimitiveVertex vertex;
            vertex.setPoint(to_coin(vertices_[v]));
            vertex.setNormal(to_coin(normals_[v]));
            vertex.setDetail(&corner);
            shapeVertex(&vertex);
        }
        face.incFaceIndex();
    }
    endShape();
}

void SoHeightField::computeBBox(SoAction*, SbBox3f& box, SbVec3f& centre) {
    if (box_.isEmpty()) return;
    box.setBounds(to_coin(box_.min()), to_coin(box_.max()));
    centre = box.getCenter();
}

}  // namespace beltgrinding
