#include "spline_surface.h"

#include <gtest/gtest.h>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>

#include <BRep_Tool.hxx>
#include <random>

#include "support.h"

namespace beltgrinding {
namespace {

constexpr double kTight = 1e-11;  // of the size of what is compared

struct Knots {
    std::vector<double> knots;
    std::vector<int> multiplicities;
    int poles = 0;
};

/// Random knots; inner ones as multiple as the degree at most.
Knots random_knots(std::mt19937& random, int degree, bool periodic) {
    std::uniform_int_distribution<int> count(2, 7), inner(1, degree);
    std::uniform_real_distribution<double> step(0.05, 2.0);
    Knots made;
    double at = -1.0;
    const int spans = count(random);
    int sum = 0;
    for (int i = 0; i <= spans; ++i, at += step(random)) {
        made.knots.push_back(at);
        made.multiplicities.push_back(i == 0 || i == spans ? degree + 1 : inner(random));
        if (periodic && (i == 0 || i == spans)) made.multiplicities.back() = 1;
        sum += made.multiplicities.back();
    }
    // A periodic one counts its seam's knot once.
    made.poles = periodic ? sum - 1 : sum - degree - 1;
    return made;
}

Handle(Geom_BSplineSurface)
    random_surface(std::mt19937& random, bool rational, bool periodic_u, bool periodic_v) {
    std::uniform_int_distribution<int> degrees(1, 5);
    std::uniform_real_distribution<double> coordinate(-50.0, 50.0), weight(0.3, 3.0);
    for (;;) {
        const int du = degrees(random), dv = degrees(random);
        const Knots u = random_knots(random, du, periodic_u);
        const Knots v = random_knots(random, dv, periodic_v);
        if ((periodic_u && u.poles <= du) || (periodic_v && v.poles <= dv)) continue;
        TColgp_Array2OfPnt poles(1, u.poles, 1, v.poles);
        TColStd_Array2OfReal weights(1, u.poles, 1, v.poles);
        for (int i = 1; i <= u.poles; ++i)
            for (int j = 1; j <= v.poles; ++j) {
                poles(i, j) = gp_Pnt(10.0 * i + 0.1 * coordinate(random), coordinate(random),
                                     10.0 * j + 0.1 * coordinate(random));
                weights(i, j) = rational ? weight(random) : 1.0;
            }
        const auto array = [](const auto& values, auto& out) {
            for (std::size_t i = 0; i < values.size(); ++i)
                out.SetValue(static_cast<int>(i) + 1, values[i]);
        };
        TColStd_Array1OfReal ku(1, static_cast<int>(u.knots.size()));
        TColStd_Array1OfReal kv(1, static_cast<int>(v.knots.size()));
        TColStd_Array1OfInteger mu(1, ku.Upper()), mv(1, kv.Upper());
        array(u.knots, ku), array(v.knots, kv);
        array(u.multiplicities, mu), array(v.multiplicities, mv);
        return new Geom_BSplineSurface(poles, weights, ku, kv, mu, mv, du, dv, periodic_u,
                                       periodic_v);
    }
}

void expect_near(const Vec3& found, const gp_XYZ& wanted, double size) {
    EXPECT_NEAR((found - Vec3(wanted.X(), wanted.Y(), wanted.Z())).norm(), 0.0, kTight * size);
}

/// By rows both ways, and alone, against OpenCASCADE.
void compare(const Handle(Geom_Surface) & surface, double u, double v) {
    const auto spline = SplineSurface::of(surface);
    ASSERT_TRUE(spline);
    const GeomAdaptor_Surface adaptor(surface);
    gp_Pnt p;
    gp_Vec du, dv;
    adaptor.D1(u, v, p, du, dv);
    const double size = 1.0 + p.XYZ().Modulus() + du.Magnitude() + dv.Magnitude();
    auto along_u = spline->row(true, v), along_v = spline->row(false, u);
    for (const SplineSurface::Point& found : {spline->at(u, v), along_u.at(u), along_v.at(v)}) {
        expect_near(found.point, p.XYZ(), size);
        expect_near(found.u, du.XYZ(), size);
        expect_near(found.v, dv.XYZ(), size);
    }
}

TEST(SplineSurface, IsOpenCascadesWhateverTheKnots) {
    std::mt19937 random(7);
    for (int round = 0; round < 200; ++round) {
        const bool periodic_u = round % 5 == 3, periodic_v = round % 7 == 4;
        const auto surface = random_surface(random, round % 2 == 1, periodic_u, periodic_v);
        double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
        surface->Bounds(u0, u1, v0, v1);
        // Periods beyond the first one, too.
        std::uniform_real_distribution<double> u(periodic_u ? u0 - (u1 - u0) : u0,
                                                 periodic_u ? u1 + 1.5 * (u1 - u0) : u1);
        std::uniform_real_distribution<double> v(periodic_v ? v0 - (v1 - v0) : v0,
                                                 periodic_v ? v1 + 1.5 * (v1 - v0) : v1);
        for (int i = 0; i < 20; ++i) compare(surface, u(random), v(random));
        compare(surface, u0, v0);
        if (!periodic_u && !periodic_v) compare(surface, u1, v1);
    }
}

TEST(SplineSurface, GoesOnBeyondItsEndsAsOpenCascadeDoes) {
    std::mt19937 random(3);
    for (int round = 0; round < 20; ++round) {
        const auto surface = random_surface(random, false, false, false);
        double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
        surface->Bounds(u0, u1, v0, v1);
        compare(surface, u0 - 0.01 * (u1 - u0), 0.4 * v0 + 0.6 * v1);
        compare(surface, 0.3 * u0 + 0.7 * u1, v1 + 0.01 * (v1 - v0));
    }
}

TEST(SplineSurface, KnowsWhatItIsMadeOf) {
    TColgp_Array2OfPnt poles(1, 4, 1, 3);
    TColStd_Array2OfReal weights(1, 4, 1, 3);
    for (int i = 1; i <= 4; ++i)
        for (int j = 1; j <= 3; ++j) {
            poles(i, j) = gp_Pnt(5.0 * i, 7.0 * j, i * j % 5);
            weights(i, j) = 1.0 + 0.2 * (i % 3);
        }
    const Handle(Geom_Surface) bezier = new Geom_BezierSurface(poles, weights);
    compare(bezier, 0.3, 0.8);
    const Handle(Geom_Surface) trimmed =
        new Geom_RectangularTrimmedSurface(bezier, 0.2, 0.7, 0.1, 0.9);
    compare(trimmed, 0.3, 0.8);
    EXPECT_FALSE(SplineSurface::of(new Geom_Plane(gp::XOY())));
    EXPECT_FALSE(SplineSurface::of(Handle(Geom_Surface)()));
}

TEST(SplineSurface, IsOpenCascadesOnRealParts) {
    const auto data = test::shared_data();
    if (data.empty()) GTEST_SKIP() << "shared data absent (set BELTGRINDING_SHARED)";
    std::size_t splines = 0;
    for (const char* file :
         {"cad/blade_marine_solid_derived.step", "cad/blade_airfoil_periodic.igs",
          "cad/housing_with_spout.brep", "cad/impeller_kj66.step"}) {
        const Shape shape = Shape::read((data / file).string());
        for (std::size_t f = 0; f < shape.face_count(); ++f) {
            const Handle(Geom_Surface) surface = BRep_Tool::Surface(shape.impl().face(f));
            if (!SplineSurface::of(surface)) continue;
            ++splines;
            double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
            surface->Bounds(u0, u1, v0, v1);
            for (int i = 0; i < 10; ++i)  // off the knots, where a side would have to be agreed on
                compare(surface, u0 + (u1 - u0) * (i + 0.4137) / 10.0,
                        v0 + (v1 - v0) * (i * 7 % 10 + 0.2719) / 10.0);
        }
    }
    EXPECT_GT(splines, 100u);
}

}  // namespace
}  // namespace beltgrinding
