#include "rays/ray_scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

struct DeviceDeleter {
    void operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
    void operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }
};

RayScene::Hit met(float distance, const Vec3f& normal, const Vec3f& direction,
                  std::uint32_t triangle, std::uint32_t mesh, float u, float v) {
    const float along = normal.dot(direction);
    const float length = normal.norm() * direction.norm();
    const float cosine = length > 0.0F ? std::abs(along) / length : 0.0F;
    return {distance, along > 0.0F, cosine, triangle, mesh, normal, u, v};
}

}  // namespace

struct RayScene::Impl {
    std::unique_ptr<RTCDeviceTy, DeviceDeleter> device;
    std::unique_ptr<RTCSceneTy, SceneDeleter> scene;
};

RayScene::RayScene(const TriangleMesh& mesh) : RayScene({&mesh, 1}, Build::kBest) {}

RayScene::RayScene(std::span<const TriangleMesh> meshes, Build build)
    : impl_(std::make_unique<Impl>()) {
    impl_->device.reset(rtcNewDevice("threads=0"));
    if (!impl_->device && rtcGetDeviceError(nullptr) != RTC_ERROR_UNSUPPORTED_CPU)
        throw std::bad_alloc();  // it starts nothing else
    if (!impl_->device)
        throw InputError("rays.no_embree",
                         "Embree could not be started; is the processor without SSE2?");
    impl_->scene.reset(rtcNewScene(impl_->device.get()));
    RTCScene scene = impl_->scene.get();
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);  // no gaps between neighbours
    if (build == Build::kBest) rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    for (const TriangleMesh& mesh : meshes) {
        if (mesh.triangles.empty()) continue;
        RTCGeometry geometry = rtcNewGeometry(impl_->device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        void* vertices =
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(Vec3f), mesh.vertices.size());
        void* indices =
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    sizeof(Triangle), mesh.triangles.size());
        if (vertices == nullptr || indices == nullptr) {
            rtcReleaseGeometry(geometry);
            throw InputError("rays.out_of_memory", "the mesh does not fit in memory");
        }
        std::uninitialized_copy(mesh.vertices.begin(), mesh.vertices.end(),
                                static_cast<Vec3f*>(vertices));
        std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(&mesh - meshes.data()));
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene);
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

RayScene::Hit RayScene::first(const Vec3f& origin, const Vec3f& direction, float near,
                              float far) const {
    RTCRayHit ray{};
    ray.ray.org_x = origin.x();
    ray.ray.org_y = origin.y();
    ray.ray.org_z = origin.z();
    ray.ray.dir_x = direction.x();
    ray.ray.dir_y = direction.y();
    ray.ray.dir_z = direction.z();
    ray.ray.tnear = near;
    ray.ray.tfar = far;
    ray.ray.mask = ~0U;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect1(impl_->scene.get(), &ray, &arguments);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect1(impl_->scene.get(), &context, &ray);
#endif
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return met(ray.ray.tfar, Vec3f(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z), direction,
               ray.hit.primID, ray.hit.geomID, ray.hit.u, ray.hit.v);
}

}  // namespace beltgrinding
