#include "tassilo/files/camera_file.h"

#include <array>
#include <cmath>
#include <sstream>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/files/atomic_file.h"
#include "tassilo/files/internal/checked.h"
#include "tassilo/files/internal/yaml_text.h"
#include "tassilo/files/yaml.h"

namespace tassilo {
namespace {

constexpr int kMaxSide = 32767;  // runs are 16 bit

struct Matrix {
  std::int64_t rows = 0, columns = 0;
  std::vector<double> data;  ///< Row-major.
  Value value;               ///< Of `data`, for messages.
};

Matrix matrix_of(const Value& value) {
  const Map map = value.map({"rows", "cols", "data"});
  const std::int64_t rows = map.at("rows").integer(1, 16), columns = map.at("cols").integer(1, 16);
  const Value data = map.at("data");
  return {rows, columns, data.numbers(static_cast<std::size_t>(rows * columns)), data};
}

Matrix matrix_of(const Value& value, std::int64_t rows, std::int64_t columns) {
  Matrix matrix = matrix_of(value);
  if (matrix.rows != rows || matrix.columns != columns)
    value.fail("has " + std::to_string(matrix.rows) + "x" + std::to_string(matrix.columns) + " values, must have " +
               std::to_string(rows) + "x" + std::to_string(columns));
  return matrix;
}

void read_camera_matrix(const Value& value, CameraModel& model) {
  const Matrix k = matrix_of(value, 3, 3);
  if (k.data[1] != 0 || k.data[3] != 0 || k.data[6] != 0 || k.data[7] != 0 || k.data[8] != 1)
    k.value.fail("must be [fx, 0, cx, 0, fy, cy, 0, 0, 1]");
  model.fx = k.data[0];
  model.cx = k.data[2];
  model.fy = k.data[4];
  model.cy = k.data[5];
}

/// R R' = 1 and det R = 1, to the digits that files usually have.
void check_rectification(const Value& value) {
  const Matrix r = matrix_of(value, 3, 3);
  const auto& d = r.data;
  double deviation = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const double dot = d[3 * i] * d[3 * j] + d[3 * i + 1] * d[3 * j + 1] + d[3 * i + 2] * d[3 * j + 2];
      deviation = std::max(deviation, std::abs(dot - (i == j ? 1.0 : 0.0)));
    }
  const double determinant =
      d[0] * (d[4] * d[8] - d[5] * d[7]) - d[1] * (d[3] * d[8] - d[5] * d[6]) + d[2] * (d[3] * d[7] - d[4] * d[6]);
  if (!(deviation < 1e-3 && determinant > 0)) r.value.fail("is no rotation, must be one");
}

void check_projection(const Value& value) {
  const Matrix p = matrix_of(value, 3, 4);
  const auto& d = p.data;
  if (!(d[0] > 0 && d[5] > 0 && d[4] == 0 && d[8] == 0 && d[9] == 0 && d[10] == 1 && d[11] == 0))
    p.value.fail("must be [fx, 0, cx, Tx, 0, fy, cy, Ty, 0, 0, 1, 0] with fx, fy > 0");
}

/// The coefficients of each model in file order, to read and to write them.
template <class Visit>
void visit_coefficients(Distortion& distortion, Visit visit) {
  if (auto* m = std::get_if<PlumbBob>(&distortion)) {
    visit({&m->k1, &m->k2, &m->p1, &m->p2, &m->k3}, "k1 k2 p1 p2 k3");
  } else if (auto* r = std::get_if<RationalPolynomial>(&distortion)) {
    visit({&r->k1, &r->k2, &r->p1, &r->p2, &r->k3, &r->k4, &r->k5, &r->k6}, "k1 k2 p1 p2 k3 k4 k5 k6");
  } else if (auto* e = std::get_if<Equidistant>(&distortion)) {
    visit({&e->k1, &e->k2, &e->k3, &e->k4}, "k1 k2 k3 k4");
  } else {
    visit({&std::get<Division>(distortion).k}, "k");
  }
}

Distortion distortion_of(const Value& name, const Value& coefficients) {
  const std::array<Distortion, 4> models{PlumbBob{}, RationalPolynomial{}, Equidistant{}, Division{}};
  std::array<std::string_view, models.size()> names;
  for (std::size_t i = 0; i < models.size(); ++i) names[i] = distortion_name(models[i]);
  Distortion distortion = models[name.choice(names)];
  const Matrix matrix = matrix_of(coefficients);
  visit_coefficients(distortion, [&](const std::vector<double*>& targets, const char* meaning) {
    if (matrix.data.size() != targets.size())
      matrix.value.fail("has " + std::to_string(matrix.data.size()) + " values, " + name.string() + " must have " +
                        std::to_string(targets.size()) + " (" + meaning + ")");
    for (std::size_t i = 0; i < targets.size(); ++i) *targets[i] = matrix.data[i];
  });
  return distortion;
}

CameraMount mount_of(const Value& value) {
  const Map map = value.map({"x", "y", "z", "roll", "pitch", "yaw"});
  constexpr double most = 10;  // [m] more are millimetres
  return {map.at("x").number(-most, most), map.at("y").number(-most, most), map.at("z").number(-most, most),
          map.at("roll").number(),         map.at("pitch").number(),        map.at("yaw").number()};
}

CameraFile camera_of(const Value& root, const std::string& file) {
  const Map map =
      root.map({"image_width", "image_height", "camera_name", "camera_matrix", "distortion_model",
                "distortion_coefficients", "rectification_matrix", "projection_matrix", "camera_pose_in_robot"});
  CameraFile camera;
  camera.model.width = static_cast<int>(map.at("image_width").integer(1, kMaxSide));
  camera.model.height = static_cast<int>(map.at("image_height").integer(1, kMaxSide));
  if (const auto name = map.find("camera_name")) camera.model.name = name->string();
  read_camera_matrix(map.at("camera_matrix"), camera.model);
  camera.model.distortion = distortion_of(map.at("distortion_model"), map.at("distortion_coefficients"));
  if (const auto matrix = map.find("rectification_matrix")) check_rectification(*matrix);
  if (const auto matrix = map.find("projection_matrix")) check_projection(*matrix);
  camera.model = checked(std::move(camera.model), file);
  if (const auto pose = map.find("camera_pose_in_robot")) camera.mount = checked(mount_of(*pose), pose->place());
  return camera;
}

CameraModel halcon_of(const Value& root, const std::string& file) {
  HalconDivision halcon;
  const auto read = [&](const Value& f, const Value& kappa, const Value& sx, const Value& sy, const Value& cx,
                        const Value& cy, const Value& width, const Value& height) {
    halcon = {f.positive(),
              kappa.number(),
              sx.positive(),
              sy.positive(),
              cx.number(),
              cy.number(),
              static_cast<int>(width.integer(1, kMaxSide)),
              static_cast<int>(height.integer(1, kMaxSide))};
  };
  if (root.is_list()) {
    const auto v = root.list(9, 9);
    constexpr std::array<std::string_view, 1> kTypes{"area_scan_division"};
    v[0].choice(kTypes);
    read(v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]);
  } else {
    const Map m = root.map({"f", "kappa", "sx", "sy", "cx", "cy", "image_width", "image_height"});
    read(m.at("f"), m.at("kappa"), m.at("sx"), m.at("sy"), m.at("cx"), m.at("cy"), m.at("image_width"),
         m.at("image_height"));
  }
  return checked(from_halcon(halcon), file);
}

std::string matrix_yaml(const std::string& key, std::size_t rows, const std::vector<double>& data) {
  std::ostringstream out;
  out << key << ":\n  rows: " << rows << "\n  cols: " << data.size() / rows << "\n  data: " << yaml_numbers(data)
      << "\n";
  return out.str();
}

}  // namespace

CameraFile read_camera(const std::filesystem::path& file) { return camera_of(read_yaml(file), file.string()); }
CameraFile camera_from_yaml(std::string_view text, const std::string& file) {
  return camera_of(parse_yaml(text, file), file);
}

std::string camera_yaml(const CameraFile& camera) {
  const CameraModel& m = camera.model;
  std::vector<double> coefficients;
  Distortion distortion = m.distortion;
  visit_coefficients(distortion, [&](const std::vector<double*>& values, const char*) {
    for (const double* value : values) coefficients.push_back(*value);
  });
  std::ostringstream out;
  out << "image_width: " << m.width << "\nimage_height: " << m.height << "\n";
  if (!m.name.empty()) out << "camera_name: " << yaml_text(m.name) << "\n";
  out << matrix_yaml("camera_matrix", 3, {m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1})
      << "distortion_model: " << distortion_name(m.distortion) << "\n"
      << matrix_yaml("distortion_coefficients", 1, coefficients)
      << matrix_yaml("rectification_matrix", 3, {1, 0, 0, 0, 1, 0, 0, 0, 1})
      << matrix_yaml("projection_matrix", 3, {m.fx, 0, m.cx, 0, 0, m.fy, m.cy, 0, 0, 0, 1, 0});
  if (const auto& pose = camera.mount)
    out << "camera_pose_in_robot: {x: " << number_text(pose->x) << ", y: " << number_text(pose->y)
        << ", z: " << number_text(pose->z) << ", roll: " << number_text(pose->roll)
        << ", pitch: " << number_text(pose->pitch) << ", yaw: " << number_text(pose->yaw) << "}\n";
  return out.str();
}

void write_camera(const std::filesystem::path& file, const CameraFile& camera) {
  write_atomically(file, camera_yaml(camera));
}

CameraModel read_halcon_camera(const std::filesystem::path& file) { return halcon_of(read_yaml(file), file.string()); }
CameraModel halcon_camera_from_yaml(std::string_view text, const std::string& file) {
  return halcon_of(parse_yaml(text, file), file);
}

std::string halcon_camera_yaml(const CameraModel& camera, double sx) {
  const HalconDivision h = to_halcon(camera, sx);
  std::ostringstream out;
  out << "# HALCON area_scan_division: f [m], kappa [1/m^2], sx, sy [m/pixel], cx, cy [pixel]\n"
      << "f: " << number_text(h.f) << "\nkappa: " << number_text(h.kappa) << "\nsx: " << number_text(h.sx)
      << "\nsy: " << number_text(h.sy) << "\ncx: " << number_text(h.cx) << "\ncy: " << number_text(h.cy)
      << "\nimage_width: " << h.width << "\nimage_height: " << h.height << "\n";
  return out.str();
}

void write_halcon_camera(const std::filesystem::path& file, const CameraModel& camera, double sx) {
  write_atomically(file, halcon_camera_yaml(camera, sx));
}

}  // namespace tassilo
