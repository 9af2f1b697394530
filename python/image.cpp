#include "tassilo/image/frame.h"

#include <cmath>
#include <filesystem>
#include <memory>
#include <mutex>

#include "bindings.h"
#include "tassilo/files/png.h"
#include "tassilo/image/bt601.h"
#include "tassilo/overlay/picture.h"
#include "tassilo/source/frame_source.h"

// Frames are looks at numpy arrays wherever rows have no gaps; only RGB is converted, as there is no RGB frame.

namespace tassilo::python {
namespace {

constexpr py::ssize_t kMaxFrameSize = 32767;  // runs have 16-bit coordinates

/// What a frame knows besides its pixels.
struct FrameFacts {
  ColorRange range = ColorRange::limited;
  double t = 0;
  std::int64_t index = 0;
  std::string image;
};

void check_bytes(const char* name, const py::array& array, const std::vector<py::ssize_t>& shape, const char* must) {
  bool fits =
      array.ndim() == static_cast<py::ssize_t>(shape.size()) && array.dtype().kind() == 'u' && array.itemsize() == 1;
  for (std::size_t k = 0; fits && k < shape.size(); ++k) fits = array.shape(static_cast<py::ssize_t>(k)) == shape[k];
  if (!fits) refuse(name, "is " + shown(array) + ", must be " + must);
}

/// Refuses arrays whose rows have gaps; the rows themselves may be anywhere.
void check_rows(const char* name, const py::array& array) {
  py::ssize_t step = 1;
  for (py::ssize_t k = array.ndim() - 1; k >= 1; --k) {
    if (array.shape(k) > 1 && array.strides(k) != step)
      refuse(name, "has gaps between the bytes of a row, must have none; numpy.ascontiguousarray makes such a copy");
    step *= array.shape(k);
  }
}

const std::uint8_t* bytes_of(const py::array& array) { return static_cast<const std::uint8_t*>(array.data()); }

void check_size(const char* name, const py::array& array, py::ssize_t dimensions) {
  if (array.ndim() != dimensions)
    refuse(name, "is " + shown(array) + ", must have " + std::to_string(dimensions) + " dimensions");
  if (array.shape(0) < 1 || array.shape(1) < 1 || array.shape(0) > kMaxFrameSize || array.shape(1) > kMaxFrameSize)
    refuse(name, "is " + shown(array) + ", must be 1 .. 32767 pixels in each direction");
}

/// A frame that keeps `arrays` alive, on whatever thread it dies.
Frame frame_of(const FrameView& view, FrameFacts facts, py::object arrays) {
  if (!std::isfinite(facts.t)) refuse("t", "is " + std::to_string(facts.t) + ", must be finite");
  Frame frame;
  frame.view = view;
  frame.range = facts.range;
  frame.t = facts.t;
  frame.index = facts.index;
  frame.image = std::move(facts.image);
  frame.storage = std::shared_ptr<py::object>(new py::object(std::move(arrays)), [](py::object* object) {
    if (Py_IsInitialized() == 0) return;
    const py::gil_scoped_acquire locked;
    delete object;
  });
  return frame;
}

Frame packed_frame(PixelFormat format, const py::array& array, FrameFacts facts) {
  check_size("array", array, 3);
  check_bytes("array", array, {array.shape(0), array.shape(1), 2}, "(height, width, 2) of uint8");
  if (array.shape(1) % 2 != 0) refuse("array", "is " + shown(array) + ", must have an even width");
  check_rows("array", array);
  return frame_of(FrameView::packed(format, static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)),
                                    bytes_of(array), array.strides(0)),
                  std::move(facts), array);
}

Frame planar_frame(PixelFormat format, const std::array<py::array, 3>& planes, FrameFacts facts) {
  const auto& [y, u, v] = planes;
  check_size("y", y, 2);
  check_bytes("y", y, {y.shape(0), y.shape(1)}, "(height, width) of uint8");
  check_rows("y", y);
  const py::ssize_t width = (y.shape(1) + 1) / 2;
  const py::ssize_t height = format == PixelFormat::yuv422p ? y.shape(0) : (y.shape(0) + 1) / 2;
  const std::string size = "(" + std::to_string(height) + ", " + std::to_string(width);
  if (format == PixelFormat::nv12) {
    if (u.ndim() == 2)
      check_bytes("uv", u, {height, 2 * width}, (size + " * 2) of uint8").c_str());
    else
      check_bytes("uv", u, {height, width, 2}, (size + ", 2) of uint8").c_str());
    check_rows("uv", u);
  } else {
    for (const auto& [name, plane] : {std::pair("u", &u), std::pair("v", &v)}) {
      check_bytes(name, *plane, {height, width}, (size + ") of uint8").c_str());
      check_rows(name, *plane);
    }
  }
  return frame_of(
      FrameView::planar(format, static_cast<int>(y.shape(1)), static_cast<int>(y.shape(0)),
                        {bytes_of(y), bytes_of(u), bytes_of(v)}, {y.strides(0), u.strides(0), v.strides(0)}),
      std::move(facts), py::make_tuple(y, u, v));
}

Frame rgb_frame(const py::array& array, FrameFacts facts) {
  check_size("array", array, 3);
  check_bytes("array", array, {array.shape(0), array.shape(1), 3}, "(height, width, 3) of uint8");
  const auto rows = py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>(array);
  const RgbView view{rows.data(), static_cast<int>(rows.shape(1)), static_cast<int>(rows.shape(0)), rows.strides(0)};
  Frame converted;
  {
    py::gil_scoped_release unlocked;
    converted = frame_from_rgb(view, facts.range);
  }
  Frame frame = frame_of(converted.view, std::move(facts), py::none());
  frame.storage = converted.storage;
  return frame;
}

py::array_t<std::uint8_t> to_yuv(const Frame& frame) {
  const FrameView& view = frame.view;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(static_cast<std::size_t>(view.width()) * static_cast<std::size_t>(view.height()) * 3);
  for (int r = 0; r < view.height(); ++r)
    for (int c = 0; c < view.width(); ++c) bytes.insert(bytes.end(), {view.y(c, r), view.u(c, r), view.v(c, r)});
  return array_of(std::move(bytes), {view.height(), view.width(), 3});
}

std::string text_of(const Frame& frame) {
  return "<tassilo.Frame: " + std::string(to_string(frame.view.format())) + " " + std::to_string(frame.view.width()) +
         "x" + std::to_string(frame.view.height()) + ", " + std::string(to_string(frame.range)) + " range>";
}

/// Binds Frame.NAME(planes ..., *, range, t, index, image).
template <class... Planes, class Make, class... Names>
void def_frame(py::class_<Frame>& frame, const char* name, Make make, const char* doc, const Names&... names) {
  frame.def_static(
      name,
      [make](Planes... planes, ColorRange range, double t, std::int64_t index, std::string image) {
        return make(planes..., FrameFacts{range, t, index, std::move(image)});
      },
      doc, names..., py::kw_only(), "range"_a = ColorRange::limited, "t"_a = 0.0, "index"_a = 0, "image"_a = "");
}

void bind_frame(py::module_& module) {
  using Array = const py::array&;
  py::class_<Frame> frame(module, "Frame",
                          R"(One camera image in a camera's own YUV layout, with what is known about it.

The pixels stay in the arrays, which the frame keeps alive and nobody should change while it is used; rows may be
anywhere, but must not have gaps. range is 'limited' or 'full', t the capture time in seconds.)");
  def_frame<Array>(
      frame, "yuyv", [](Array a, FrameFacts facts) { return packed_frame(PixelFormat::yuyv422, a, std::move(facts)); },
      "Packed Y U Y V: (height, width, 2), even width.", "array"_a);
  def_frame<Array>(
      frame, "uyvy", [](Array a, FrameFacts facts) { return packed_frame(PixelFormat::uyvy422, a, std::move(facts)); },
      "Packed U Y V Y: (height, width, 2), even width.", "array"_a);
  def_frame<Array, Array, Array>(
      frame, "yuv422p",
      [](Array y, Array u, Array v, FrameFacts facts) {
        return planar_frame(PixelFormat::yuv422p, {y, u, v}, std::move(facts));
      },
      "Planes (height, width), and twice (height, width / 2, rounded up).", "y"_a, "u"_a, "v"_a);
  def_frame<Array, Array, Array>(
      frame, "yuv420p",
      [](Array y, Array u, Array v, FrameFacts facts) {
        return planar_frame(PixelFormat::yuv420p, {y, u, v}, std::move(facts));
      },
      "Planes (height, width), and twice (height / 2, width / 2), rounded up.", "y"_a, "u"_a, "v"_a);
  def_frame<Array, Array>(
      frame, "nv12",
      [](Array y, Array uv, FrameFacts facts) {
        return planar_frame(PixelFormat::nv12, {y, uv, uv}, std::move(facts));
      },
      "Planes (height, width) and (height / 2, width / 2, 2), rounded up; the latter may have two dimensions.", "y"_a,
      "uv"_a);
  def_frame<Array>(
      frame, "rgb", &rgb_frame,
      "(height, width, 3) of R, G, B, converted to BT.601 in the range, chroma averaged over pairs of columns.",
      "array"_a);
  frame.def_property_readonly("width", [](const Frame& f) { return f.view.width(); })
      .def_property_readonly("height", [](const Frame& f) { return f.view.height(); })
      .def_property_readonly("format", [](const Frame& f) { return std::string(to_string(f.view.format())); })
      .def_property_readonly(
          "range", [](const Frame& f) { return f.range; }, "'limited' or 'full'.")
      .def_property_readonly(
          "t", [](const Frame& f) { return f.t; }, "Capture time on the source's clock [s].")
      .def_property_readonly(
          "index", [](const Frame& f) { return f.index; }, "0-based position in the source.")
      .def_property_readonly(
          "image", [](const Frame& f) { return f.image; }, "File name of a single image, else ''.")
      .def("to_yuv", &to_yuv, "A (height, width, 3) copy with Y, U, V of every pixel.")
      .def(
          "to_rgb",
          [](const Frame& f) {
            Picture picture = picture_from_frame(f.view, f.range);
            return array_of(std::move(picture.pixels), {picture.height, picture.width, 3});
          },
          "A (height, width, 3) copy in R, G, B.")
      .def("__repr__", [](const Frame& f) { return text_of(f); });
}

/// A source for one thread at a time, with the lock that sees to it.
struct LockedSource {
  FrameSource source;
  std::mutex mutex = {};
};

SourceOptions source_options(const std::filesystem::path& location, ColorRange images_range) {
  SourceOptions options;
  options.location = location.string();
  options.images_range = images_range;
  // Ctrl-C ends the wait for a camera.
  options.interrupted = [] {
    const py::gil_scoped_acquire locked;
    return PyErr_CheckSignals() != 0;
  };
  return options;
}

void bind_source(py::module_& module) {
  py::class_<LockedSource, std::shared_ptr<LockedSource>>(module, "FrameSource",
                                                          "An iterator over the frames of a video; see open_source.")
      .def("__iter__", [](LockedSource& self) -> LockedSource& { return self; })
      .def("__next__",
           [](LockedSource& self) {
             std::optional<Frame> frame;
             {
               py::gil_scoped_release unlocked;
               const std::lock_guard only(self.mutex);
               frame = self.source.next();
             }
             if (PyErr_Occurred()) throw py::error_already_set();
             if (!frame) throw py::stop_iteration();
             return std::move(*frame);
           })
      .def_property_readonly("name", [](const LockedSource& s) { return s.source.info().name; })
      .def_property_readonly("description", [](const LockedSource& s) { return s.source.info().description; })
      .def_property_readonly("width", [](const LockedSource& s) { return s.source.info().width; })
      .def_property_readonly("height", [](const LockedSource& s) { return s.source.info().height; })
      .def_property_readonly("range", [](const LockedSource& s) { return s.source.info().range; })
      .def_property_readonly(
          "frame_count", [](const LockedSource& s) { return s.source.info().frame_count; },
          "As far as the container tells, else None.");
  module.def(
      "open_source",
      [](const std::filesystem::path& location, ColorRange images_range) {
        const SourceOptions options = source_options(location, images_range);
        std::shared_ptr<LockedSource> source;
        {
          py::gil_scoped_release unlocked;
          source.reset(new LockedSource{open_source(options)});
        }
        if (PyErr_Occurred()) throw py::error_already_set();
        return source;
      },
      "The frames of a video or image file, a folder of images or a URL; RGB images become BT.601 in images_range.",
      "location"_a, "images_range"_a = ColorRange::limited);
}

void bind_png(py::module_& module) {
  module.def(
      "read_png",
      [](const std::filesystem::path& path) {
        RgbImage image = read_png_rgb(path);
        return array_of(std::move(image.pixels), {image.height, image.width, 3});
      },
      "Any PNG as (height, width, 3) of R, G, B.", "path"_a);
  module.def(
      "write_png",
      [](const std::filesystem::path& path, const py::array& image) {
        const bool is_gray = image.ndim() == 2;
        if (!is_gray && image.ndim() != 3) refuse("image", "is " + shown(image) + ", must be (height, width[, 3])");
        check_size("image", image, image.ndim());
        if (is_gray)
          check_bytes("image", image, {image.shape(0), image.shape(1)}, "(height, width) of uint8");
        else
          check_bytes("image", image, {image.shape(0), image.shape(1), 3}, "(height, width, 3) of uint8");
        if (image.shape(0) * image.shape(1) > py::ssize_t{1} << 28)
          refuse("image", "is " + shown(image) + ", must have at most 2^28 pixels");
        const auto rows = py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>(image);
        const int width = static_cast<int>(image.shape(1)), height = static_cast<int>(image.shape(0));
        std::vector<std::uint8_t> bytes(rows.data(), rows.data() + rows.size());
        py::gil_scoped_release unlocked;
        if (is_gray)
          write_png_gray(path, {width, height, std::move(bytes)});
        else
          write_png_rgb(path, {width, height, std::move(bytes)});
      },
      "Writes (height, width) gray values or (height, width, 3) of R, G, B.", "path"_a, "image"_a);
}

}  // namespace

void bind_image(py::module_& module) {
  bind_frame(module);
  bind_source(module);
  bind_png(module);
}

}  // namespace tassilo::python
