#include "tassilo/sim/internal/ray_world.h"

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

RTCIntersectContext coherent_context() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

void attach_triangles(RTCDevice device, RTCScene scene, std::span<const Eigen::Vector3f> vertices,
                      std::span<const std::array<std::uint32_t, 3>> triangles) {
  const RtcGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* to_vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices.size()));
  auto* to_triangles = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles.size()));
  if (to_vertices == nullptr || to_triangles == nullptr) throw Error("embree", "has no memory for the scene");
  for (const Eigen::Vector3f& v : vertices) to_vertices = std::copy(v.data(), v.data() + 3, to_vertices);
  for (const auto& t : triangles) to_triangles = std::copy(t.begin(), t.end(), to_triangles);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene, geometry.get());
}

/// Radius 1, from z = 0 to 1, closed at the top. Its corners lie as far outside as the middles of its sides inside.
void attach_cylinder(RTCDevice device, RTCScene scene) {
  constexpr std::uint32_t sides = 96;
  const double radius = 2 / (1 + std::cos(std::numbers::pi / sides));
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    const auto x = static_cast<float>(radius * std::cos(angle)), y = static_cast<float>(radius * std::sin(angle));
    vertices.emplace_back(x, y, 0.F);
    vertices.emplace_back(x, y, 1.F);
    const std::uint32_t a = 2 * k, b = 2 * ((k + 1) % sides);
    triangles.push_back({a, b, b + 1});
    triangles.push_back({a, b + 1, a + 1});
    triangles.push_back({2 * sides, a + 1, b + 1});
  }
  vertices.emplace_back(0.F, 0.F, 1.F);
  attach_triangles(device, scene, vertices, triangles);
}

void attach_sphere(RTCDevice device, RTCScene scene) {
  const RtcGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT));
  auto* point = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 1));
  if (point == nullptr) throw Error("embree", "has no memory for the scene");
  point[0] = point[1] = point[2] = 0;
  point[3] = 1;
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene, geometry.get());
}

}  // namespace

RtcScene RayWorld::new_scene(RTCSceneFlags flags) const {
  RtcScene scene(rtcNewScene(device_.get()));
  if (!scene) throw Error("embree", "cannot make a scene");
  rtcSetSceneFlags(scene.get(), flags);
  return scene;
}

RayWorld::RayWorld(const Stage& stage, bool watertight) : device_(rtcNewDevice("threads=1,set_affinity=0")) {
  if (!device_) throw Error("embree", "cannot be started on this machine");
  const RTCSceneFlags flags = watertight ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE;
  stage_ = new_scene(flags);
  casters_ = new_scene(flags);
  sphere_ = new_scene(flags);
  cylinder_ = new_scene(flags);
  moving_ = new_scene(RTC_SCENE_FLAG_DYNAMIC);
  std::vector<std::array<std::uint32_t, 3>> triangles, casters;
  for (const Stage::Triangle& triangle : stage.triangles) {
    triangles.push_back(triangle.corners);
    const Surface& surface = stage.surfaces[triangle.surface];
    if (!surface.is_outside && !surface.is_floor) casters.push_back(triangle.corners);
  }
  attach_triangles(device_.get(), stage_.get(), stage.vertices, triangles);
  if (!casters.empty()) attach_triangles(device_.get(), casters_.get(), stage.vertices, casters);
  attach_sphere(device_.get(), sphere_.get());
  attach_cylinder(device_.get(), cylinder_.get());
  for (const RtcScene* scene : {&stage_, &casters_, &sphere_, &cylinder_, &moving_}) rtcCommitScene(scene->get());
  if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) throw Error("embree", "refused the scene");
}

void RayWorld::place(std::span<const MovingPart> parts) {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const MovingPart& part = parts[k];
    if (k == instances_.size()) {
      instances_.emplace_back(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
      shapes_.push_back(part.shape);
      rtcSetGeometryTimeStepCount(instances_[k].get(), 1);
      rtcSetGeometryInstancedScene(instances_[k].get(),
                                   part.shape == MovingPart::Shape::sphere ? sphere_.get() : cylinder_.get());
      rtcAttachGeometryByID(moving_.get(), instances_[k].get(), static_cast<unsigned>(k));
    } else if (shapes_[k] != part.shape) {
      shapes_[k] = part.shape;
      rtcSetGeometryInstancedScene(instances_[k].get(),
                                   part.shape == MovingPart::Shape::sphere ? sphere_.get() : cylinder_.get());
    }
    const float up = part.shape == MovingPart::Shape::sphere ? part.radius : part.height;
    const std::array<float, 12> columns{part.radius, 0, 0, 0, part.radius, 0, 0, 0, up, part.x, part.y, part.z};
    rtcSetGeometryTransform(instances_[k].get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcEnableGeometry(instances_[k].get());
    rtcCommitGeometry(instances_[k].get());
  }
  for (std::size_t k = parts.size(); k < instances_.size(); ++k) rtcDisableGeometry(instances_[k].get());
  rtcCommitScene(moving_.get());
}

void RayWorld::intersect(const LaneMask& valid, RTCRayHit8& rays) const {
  RTCIntersectContext context = coherent_context();
  rtcIntersect8(valid.lane, stage_.get(), &context, &rays);
  rtcIntersect8(valid.lane, moving_.get(), &context, &rays);
}

void RayWorld::occluded(const LaneMask& valid, RTCRay8& rays, bool by_stage, bool by_parts) const {
  RTCIntersectContext context = coherent_context();
  if (by_parts) rtcOccluded8(valid.lane, moving_.get(), &context, &rays);
  if (by_stage) rtcOccluded8(valid.lane, casters_.get(), &context, &rays);
}

void RayWorld::intersect_part(const LaneMask& valid, const MovingPart& part, RTCRayHit8& rays) const {
  RTCIntersectContext context = coherent_context();
  const float up = part.shape == MovingPart::Shape::sphere ? part.radius : part.height;
  for (int k = 0; k < 8; ++k) {
    rays.ray.org_x[k] = (rays.ray.org_x[k] - part.x) / part.radius;
    rays.ray.org_y[k] = (rays.ray.org_y[k] - part.y) / part.radius;
    rays.ray.org_z[k] = (rays.ray.org_z[k] - part.z) / up;
    rays.ray.dir_x[k] /= part.radius;
    rays.ray.dir_y[k] /= part.radius;
    rays.ray.dir_z[k] /= up;
  }
  rtcIntersect8(valid.lane, part.shape == MovingPart::Shape::sphere ? sphere_.get() : cylinder_.get(), &context, &rays);
}

}  // namespace tassilo
