#include "shape_transfer.h"

#include <BRep_CurveRepresentation.hxx>
#include <BRep_ListIteratorOfListOfCurveRepresentation.hxx>
#include <BRep_ListIteratorOfListOfPointRepresentation.hxx>
#include <BRep_PointRepresentation.hxx>
#include <BRep_TEdge.hxx>
#include <BRep_TFace.hxx>
#include <BRep_TVertex.hxx>
#include <BinTools.hxx>
#include <Geom2d_Conic.hxx>
#include <Geom2d_Line.hxx>
#include <Geom2d_OffsetCurve.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <Geom_Conic.hxx>
#include <Geom_ElementarySurface.hxx>
#include <Geom_Line.hxx>
#include <Geom_OffsetCurve.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Standard_Failure.hxx>
#include <TopLoc_Datum3D.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_TShape.hxx>
#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <type_traits>
#include <unordered_set>
#include <utility>
#include <vector>

namespace beltgrinding {
namespace {

/// gp_Trsf's own members: its setters make the matrix orthogonal again, which changes last bits.
struct RawTransformation {
    double scale;
    gp_TrsfForm form;
    gp_Mat matrix;
    gp_XYZ translation;
};
static_assert(sizeof(RawTransformation) == sizeof(gp_Trsf));

class Writer {
  public:
    template <class T>
    void value(T& number) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
    }
    std::string& bytes() { return bytes_; }

  private:
    std::string bytes_;
};

class Reader {
  public:
    explicit Reader(std::string_view bytes) : bytes_(bytes) {}
    template <class T>
    void value(T& number) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (bytes_.size() < sizeof number) throw Standard_Failure("the shape's numbers end early");
        std::memcpy(static_cast<void*>(&number), bytes_.data(), sizeof number);
        bytes_.remove_prefix(sizeof number);
    }
    bool at_end() const { return bytes_.empty(); }

  private:
    std::string_view bytes_;
};

/// Walks a shape in an order that its structure alone gives, and hands on every number that
/// OpenCASCADE's binary format does not keep to the last bit: directions (normalised again when
/// read), axis systems (made orthogonal again), transformations, and the flags that reading resets.
/// `Numbers` writes them down or puts them back.
template <class Numbers>
class Walk {
  public:
    explicit Walk(Numbers& numbers) : numbers_(numbers) {}

    void shape(const TopoDS_Shape& shape) {
        if (shape.IsNull()) return;
        location(shape.Location());
        const Handle(TopoDS_TShape)& inner = shape.TShape();
        if (!seen_.insert(inner.get()).second) return;
        if (shape.ShapeType() == TopAbs_VERTEX) {
            points(Handle(BRep_TVertex)::DownCast(inner));
        } else if (shape.ShapeType() == TopAbs_EDGE) {
            curves(Handle(BRep_TEdge)::DownCast(inner));
        } else if (shape.ShapeType() == TopAbs_FACE) {
            const Handle(BRep_TFace) face = Handle(BRep_TFace)::DownCast(inner);
            location(face->Location());
            surface(face->Surface());
        }
        for (TopoDS_Iterator part(shape, false, false); part.More(); part.Next())
            this->shape(part.Value());
        flags(*inner);
    }

  private:
    void flags(TopoDS_TShape& inner) {
        std::uint8_t set = std::uint8_t(
            inner.Free() | inner.Modified() << 1 | inner.Checked() << 2 | inner.Orientable() << 3 |
            inner.Closed() << 4 | inner.Infinite() << 5 | inner.Convex() << 6);
        numbers_.value(set);
        inner.Free(set & 1);
        inner.Modified(set & 2);
        inner.Checked(set & 4);  // after Modified, which takes it away
        inner.Orientable(set & 8);
        inner.Closed(set & 16);
        inner.Infinite(set & 32);
        inner.Convex(set & 64);
    }

    void points(const Handle(BRep_TVertex) & vertex) {
        for (BRep_ListIteratorOfListOfPointRepresentation i(vertex->Points()); i.More(); i.Next()) {
            const Handle(BRep_PointRepresentation)& point = i.Value();
            location(point->Location());
            if (point->IsPointOnCurve()) curve(point->Curve());
            if (point->IsPointOnCurveOnSurface()) curve_2d(point->PCurve());
            if (point->IsPointOnCurveOnSurface() || point->IsPointOnSurface())
                surface(point->Surface());
        }
    }

    void curves(const Handle(BRep_TEdge) & edge) {
        for (BRep_ListIteratorOfListOfCurveRepresentation i(edge->Curves()); i.More(); i.Next()) {
            const Handle(BRep_CurveRepresentation)& one = i.Value();
            // The format drops polygons of triangulations that no face has any more. Their places
            // are looked up by them, never computed with.
            if (one->IsPolygonOnTriangulation() || one->IsPolygon3D() || one->IsPolygonOnSurface())
                continue;
            location(one->Location());
            if (one->IsCurve3D()) curve(one->Curve3D());
            if (one->IsCurveOnSurface()) {
                surface(one->Surface());
                curve_2d(one->PCurve());
                if (one->IsCurveOnClosedSurface()) curve_2d(one->PCurve2());
            }
            if (one->IsRegularity()) {
                surface(one->Surface());
                surface(one->Surface2());
                location(one->Location2());
            }
        }
    }

    void location(const TopLoc_Location& whole) {
        for (TopLoc_Location rest = whole; !rest.IsIdentity(); rest = rest.NextLocation()) {
            const gp_Trsf& datum = rest.FirstDatum()->Transformation();
            if (seen_.insert(&datum).second) transformation(datum);
            product(rest);
        }
    }

    /// The product that a location keeps. Copies of shapes have it many times over, which reading
    /// makes one of: it stands in the numbers once for each chain of data and their powers.
    void product(const TopLoc_Location& location) {
        std::vector<std::pair<const void*, int>> chain;
        for (TopLoc_Location rest = location; !rest.IsIdentity(); rest = rest.NextLocation())
            chain.emplace_back(rest.FirstDatum().get(), rest.FirstPower());
        const gp_Trsf& kept = location.Transformation();
        const auto [known, first] = products_.try_emplace(std::move(chain), nullptr);
        if (first) {
            transformation(kept);
            known->second = &kept;
        } else if (known->second != &kept) {
            if constexpr (std::is_same_v<Numbers, Reader>)
                const_cast<gp_Trsf&>(kept) = *known->second;
        }
    }

    // A location offers no way to change it, and none to be made of raw numbers; the object itself
    // is not const.
    void transformation(const gp_Trsf& kept) {
        auto raw = std::bit_cast<RawTransformation>(kept);
        numbers_.value(raw.scale);
        numbers_.value(raw.form);
        numbers_.value(raw.matrix);
        numbers_.value(raw.translation);
        const_cast<gp_Trsf&>(kept) = std::bit_cast<gp_Trsf>(raw);
    }

    /// False for none, and for what was met before.
    bool first_met(const Handle(Standard_Transient) & object) {
        return !object.IsNull() && seen_.insert(object.get()).second;
    }

    void curve(const Handle(Geom_Curve) & any) {
        if (!first_met(any)) return;
        if (const auto line = Handle(Geom_Line)::DownCast(any); !line.IsNull()) {
            gp_Ax1 axis = line->Position();
            numbers_.value(axis);
            line->SetPosition(axis);
        } else if (const auto conic = Handle(Geom_Conic)::DownCast(any); !conic.IsNull()) {
            gp_Ax2 axes = conic->Position();
            numbers_.value(axes);
            conic->SetPosition(axes);
        } else if (const auto trimmed = Handle(Geom_TrimmedCurve)::DownCast(any);
                   !trimmed.IsNull()) {
            curve(trimmed->BasisCurve());
        } else if (const auto offset = Handle(Geom_OffsetCurve)::DownCast(any); !offset.IsNull()) {
            gp_Dir direction = offset->Direction();
            numbers_.value(direction);
            offset->SetDirection(direction);
            curve(offset->BasisCurve());
        }
    }

    void curve_2d(const Handle(Geom2d_Curve) & any) {
        if (!first_met(any)) return;
        if (const auto line = Handle(Geom2d_Line)::DownCast(any); !line.IsNull()) {
            gp_Ax2d axis = line->Position();
            numbers_.value(axis);
            line->SetPosition(axis);
        } else if (const auto conic = Handle(Geom2d_Conic)::DownCast(any); !conic.IsNull()) {
            gp_Ax22d axes = conic->Position();
            numbers_.value(axes);
            conic->SetAxis(axes);
        } else if (const auto trimmed = Handle(Geom2d_TrimmedCurve)::DownCast(any);
                   !trimmed.IsNull()) {
            curve_2d(trimmed->BasisCurve());
        } else if (const auto offset = Handle(Geom2d_OffsetCurve)::DownCast(any);
                   !offset.IsNull()) {
            curve_2d(offset->BasisCurve());
        }
    }

    void surface(const Handle(Geom_Surface) & any) {
        if (!first_met(any)) return;
        if (const auto plain = Handle(Geom_ElementarySurface)::DownCast(any); !plain.IsNull()) {
            gp_Ax3 axes = plain->Position();
            numbers_.value(axes);
            plain->SetPosition(axes);
        } else if (const auto swept = Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(any);
                   !swept.IsNull()) {
            gp_Dir direction = swept->Direction();
            numbers_.value(direction);
            swept->SetDirection(direction);
            curve(swept->BasisCurve());
        } else if (const auto turned = Handle(Geom_SurfaceOfRevolution)::DownCast(any);
                   !turned.IsNull()) {
            gp_Ax1 axis = turned->Axis();
            numbers_.value(axis);
            turned->SetAxis(axis);
            curve(turned->BasisCurve());
        } else if (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(any);
                   !trimmed.IsNull()) {
            surface(trimmed->BasisSurface());
        } else if (const auto offset = Handle(Geom_OffsetSurface)::DownCast(any);
                   !offset.IsNull()) {
            const Handle(Geom_Surface) basis = offset->BasisSurface();
            surface(basis);
            // It keeps a surface made of its basis, from before that was exact.
            if constexpr (std::is_same_v<Numbers, Reader>) offset->SetBasisSurface(basis, true);
        }
    }

    Numbers& numbers_;
    std::unordered_set<const void*> seen_;
    std::map<std::vector<std::pair<const void*, int>>, const gp_Trsf*> products_;
};

}  // namespace

std::string pack_shape(const TopoDS_Shape& shape) {
    std::ostringstream stream;
    BinTools::Write(shape, stream);
    std::string structure = std::move(stream).str();
    Writer numbers;
    Walk<Writer>(numbers).shape(shape);
    const std::uint64_t size = structure.size();
    std::string bytes(reinterpret_cast<const char*>(&size), sizeof size);
    bytes += structure;
    bytes += numbers.bytes();
    return bytes;
}

TopoDS_Shape unpack_shape(std::string_view bytes) {
    std::uint64_t size = 0;
    if (bytes.size() < sizeof size) throw Standard_Failure("no shape");
    std::memcpy(&size, bytes.data(), sizeof size);
    bytes.remove_prefix(sizeof size);
    if (bytes.size() < size) throw Standard_Failure("half a shape");
    std::istringstream stream{std::string(bytes.substr(0, size))};
    TopoDS_Shape shape;
    BinTools::Read(shape, stream);
    Reader numbers(bytes.substr(size));
    Walk<Reader>(numbers).shape(shape);
    if (!numbers.at_end()) throw Standard_Failure("more numbers than the shape has");
    return shape;
}

}  // namespace beltgrinding
