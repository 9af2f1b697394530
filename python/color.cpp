#include "tassilo/color/color_table.h"

#include <algorithm>
#include <map>
#include <utility>

#include "bindings.h"
#include "colors.h"
#include "tassilo/app/training.h"
#include "tassilo/base/error.h"
#include "tassilo/color/quality.h"
#include "tassilo/color/train.h"

namespace tassilo::python {
namespace {

/// Checks of the library whose subject is a Python argument: ValueError instead of tassilo.Error.
template <class Check>
void as_argument(Check check) {
  try {
    check();
  } catch (const Error& error) {
    throw py::value_error(error.what());
  }
}

SharedColors make_colors(const py::array& chroma, const std::map<ColorClass, std::pair<int, int>>& brightness,
                         ColorRange range, const std::optional<std::vector<ColorClass>>& priority) {
  const bool is_table = chroma.ndim() == 2 && chroma.shape(0) == 256 && chroma.shape(1) == 256 &&
                        chroma.dtype().kind() == 'u' && chroma.itemsize() == 1;
  if (!is_table) refuse("chroma", "is " + shown(chroma) + ", must be (256, 256) of uint8");
  ColorsFile file;
  const auto cells = py::array_t<ClassBits, py::array::c_style | py::array::forcecast>(chroma);
  std::copy_n(cells.data(), file.table.chroma.size(), file.table.chroma.begin());
  for (BrightnessInterval& interval : file.table.brightness) interval = {1, 0};
  for (const auto& [color, interval] : brightness) {
    if (color == ColorClass::no_color) refuse("brightness", "names no_color, must name color classes");
    file.table.brightness[static_cast<std::size_t>(class_index(color))] = {interval.first, interval.second};
  }
  file.table.range = range;
  if (priority) {
    if (priority->size() != file.table.priority.size())
      refuse("priority", "has " + std::to_string(priority->size()) + " classes, must have all 8");
    std::ranges::copy(*priority, file.table.priority.begin());
  }
  as_argument([&] { file.table.check(); });
  return std::make_shared<Colors>(std::move(file));
}

py::dict brightness_of(const Colors& colors) {
  py::dict intervals;
  for (const ColorClass color : kColorClasses) {
    const BrightnessInterval& interval = colors.file.table.brightness[static_cast<std::size_t>(class_index(color))];
    if (interval.low <= interval.high) intervals[py::cast(color)] = py::make_tuple(interval.low, interval.high);
  }
  return intervals;
}

py::object trained_from(const Colors& colors) {
  if (!colors.file.trained_from) return py::none();
  const Provenance& provenance = *colors.file.trained_from;
  py::dict quality;
  for (const auto& [color, figures] : provenance.quality)
    quality[py::cast(color)] = py::dict("precision"_a = figures.precision, "recall"_a = figures.recall);
  return py::dict("samples"_a = provenance.samples, "date"_a = provenance.date, "notes"_a = provenance.notes,
                  "quality"_a = quality);
}

void bind_table(py::module_& module) {
  py::class_<Colors, SharedColors>(module, "ColorTable", R"(Which colors are which class; never changed.

A pixel (Y, U, V) belongs to a class when chroma[V, U] has the class's bit (1 black, 2 white, 4 green, ... 128 yellow)
and Y lies in its brightness interval; of several such classes the first in `priority` wins.)")
      .def(py::init(&make_colors),
           "From a (256, 256) uint8 array of class bits, and closed brightness intervals by class name.", "chroma"_a,
           "brightness"_a, "range"_a = ColorRange::limited, "priority"_a = py::none())
      .def_static(
          "load", [](const std::filesystem::path& path) { return std::make_shared<Colors>(read_colors(path)); },
          "Reads colors.yaml and its PNG.", "path"_a)
      .def(
          "save", [](const Colors& colors, const std::filesystem::path& path) { write_colors(path, colors.file); },
          "Writes colors.yaml, and its PNG beside it.", "path"_a)
      .def_property_readonly(
          "chroma",
          [](const py::object& self) {
            return view_of(self.cast<const Colors&>().file.table.chroma.data(), {256, 256}, self);
          },
          "(256, 256) class bits by [V, U]; read-only, without a copy.")
      .def_property_readonly("brightness", &brightness_of, "Closed intervals (low, high) by class name.")
      .def_property_readonly(
          "range", [](const Colors& colors) { return colors.file.table.range; },
          "The color range of the frames it was trained for.")
      .def_property_readonly(
          "priority",
          [](const Colors& colors) {
            return std::vector<ColorClass>(colors.file.table.priority.begin(), colors.file.table.priority.end());
          },
          "All 8 class names; the first wins.")
      .def_property_readonly("trained_from", &trained_from,
                             "samples, date, notes and quality (precision and recall by class name), or None.")
      .def(
          "classify",
          [](const Colors& colors, std::uint8_t y, std::uint8_t u, std::uint8_t v) {
            return classify(colors.file.table, y, u, v);
          },
          "The class name of one pixel, or 'no_color'.", "y"_a, "u"_a, "v"_a)
      .def(
          "__eq__", [](const Colors& a, const Colors& b) { return a.file.table == b.file.table; }, py::is_operator(),
          "other"_a)
      .def("__repr__", [](const Colors& colors) {
        return "<tassilo.ColorTable: " + py::str(py::list(brightness_of(colors))).cast<std::string>() + ", " +
               std::string(to_string(colors.file.table.range)) + " range>";
      });
}

void check_range(const char* name, const Frame& frame, ColorRange range) {
  if (frame.range != range)
    refuse(name, "has " + std::string(to_string(frame.range)) + " color range, must be " +
                     std::string(to_string(range)) + " as the color table");
}

void bind_segment(py::module_& module) {
  py::class_<Segmentation>(module, "Segmentation",
                           "One region per color class for one frame: segmentation['red']. See segment.")
      .def_readonly("width", &Segmentation::width)
      .def_readonly("height", &Segmentation::height)
      .def_property_readonly(
          "labels",
          [](const py::object& self) {
            const auto& segmentation = self.cast<const Segmentation&>();
            return view_of(segmentation.labels.data(), {segmentation.height, segmentation.width}, self);
          },
          "(height, width) of labels 0..8: no_color, black, white, green, blue, cyan, magenta, red, yellow; read-only, "
          "without a copy.")
      .def_property_readonly(
          "regions",
          [](const Segmentation& segmentation) {
            std::map<ColorClass, Region> regions;
            for (const ColorClass color : kColorClasses) regions[color] = segmentation.of(color);
            return regions;
          },
          "The regions by class name.")
      .def(
          "__getitem__",
          [](const Segmentation& segmentation, ColorClass color) {
            if (color == ColorClass::no_color)
              refuse("color class", "is 'no_color', must be a class; its pixels are in none");
            return segmentation.of(color);
          },
          "color"_a)
      .def("__repr__", [](const Segmentation& segmentation) {
        return "<tassilo.Segmentation: " + std::to_string(segmentation.width) + "x" +
               std::to_string(segmentation.height) + ">";
      });
  module.def(
      "segment",
      [](const Frame& frame, const Colors& colors) {
        check_range("frame", frame, colors.file.table.range);
        py::gil_scoped_release unlocked;
        return segment(frame.view, colors.classifier);
      },
      "Classifies every pixel of a frame and run-length encodes at once.", "frame"_a, "colors"_a);
  module.def(
      "segment_opened",
      [](const Frame& frame, const Colors& colors) {
        check_range("frame", frame, colors.file.table.range);
        py::gil_scoped_release unlocked;
        return segment_opened(frame.view, colors.classifier);
      },
      "The same with every region opened by 3 x 3 pixels: single odd pixels become no_color.", "frame"_a, "colors"_a);
  module.def(
      "opening3x3",
      [](const Segmentation& segmentation) {
        py::gil_scoped_release unlocked;
        return opening3x3(segmentation);
      },
      "Opens every region of a segmentation by 3 x 3 pixels, as segment_opened does on the way.", "segmentation"_a);
}

TrainingOptions training_options(const std::map<std::string, double>& values) {
  TrainingOptions options;
  for (const auto& [name, value] : values) {
    const auto numbers = training_numbers();
    const auto number = std::ranges::find(numbers, name, &TrainingNumber::key);
    if (number == numbers.end()) {
      std::string names;
      for (const TrainingNumber& one : numbers) names.append(names.empty() ? "" : ", ").append(one.key);
      refuse("option", "is '" + name + "', must be one of " + names);
    }
    as_argument([&] { number->set(options, value); });
  }
  return options;
}

/// Samples from a samples file, or from (frame, region, class name) tuples; samples of one frame object are one group.
TrainingSet training_set(const py::object& samples, ColorRange images_range, const Warn& warn) {
  if (py::isinstance<py::str>(samples) || py::hasattr(samples, "__fspath__")) {
    const std::string file = samples.cast<std::filesystem::path>().string();
    py::gil_scoped_release unlocked;
    return {file, load_samples(file, images_range, warn)};
  }
  TrainingSet set{"arrays", {}};
  std::map<const Frame*, int> group_of;
  for (const py::handle item : samples) {
    if (!py::isinstance<py::sequence>(item) || py::len(item) != 3)
      refuse("sample", "is " + py::repr(item).cast<std::string>() + ", must be (frame, region, class name)");
    const auto sample = py::reinterpret_borrow<py::sequence>(item);
    const py::object first = sample[0], second = sample[1], third = sample[2];
    const auto& frame = as<const Frame&>("frame of a sample", first, "a Frame");
    const auto& region = as<const Region&>("region of a sample", second, "a Region");
    if (set.loaded.range) check_range("a frame of the samples", frame, *set.loaded.range);
    set.loaded.range = frame.range;
    const int group = group_of.emplace(&frame, static_cast<int>(group_of.size())).first->second;
    std::vector<YuvPixel> pixels = pixels_of(frame.view, region);
    if (pixels.empty()) refuse("region of a sample", "has no pixel in its frame, must have one");
    const auto color = as<ColorClass>("class of a sample", third, "a name");
    set.loaded.samples.push_back({color, group, std::move(pixels)});
  }
  set.loaded.images = static_cast<int>(group_of.size());
  return set;
}

void warn_in_python(const std::string& what, const std::string& reason) {
  const py::gil_scoped_acquire locked;
  if (PyErr_WarnEx(PyExc_UserWarning, (what + ": " + reason).c_str(), 2) != 0) throw py::error_already_set();
}

py::object figures_of(const ColorQuality& quality) {
  using Counts = std::array<std::array<std::int64_t, kColorClassCount + 1>, kColorClassCount + 1>;
  const auto matrix = [](const Counts& counts) {
    std::vector<std::int64_t> values;
    for (const auto& row : counts) values.insert(values.end(), row.begin(), row.end());
    return array_of(std::move(values), {kColorClassCount + 1, kColorClassCount + 1});
  };
  py::dict precision, recall;
  for (const ColorClass color : kColorClasses) {
    if (quality.pixels(color) == 0) continue;
    precision[py::cast(color)] = quality.precision(color);
    recall[py::cast(color)] = quality.recall(color);
  }
  return py::dict("precision"_a = precision, "recall"_a = recall, "confusion"_a = matrix(quality.confusion),
                  "overlap"_a = matrix(quality.overlap));
}

void bind_training(py::module_& module) {
  module.def(
      "train_colors",
      [](const py::object& samples, const py::object& held_out, ColorRange images_range,
         const std::map<std::string, double>& options) {
        const TrainingOptions checked = training_options(options);
        const TrainingSet set = training_set(samples, images_range, warn_in_python);
        std::optional<TrainingSet> test;
        if (!held_out.is_none()) test = training_set(held_out, images_range, warn_in_python);
        py::gil_scoped_release unlocked;
        return std::make_shared<Colors>(train_colors_file(set, test ? &*test : nullptr, checked, warn_in_python).file);
      },
      "A table from labelled regions: the path of a samples.yaml, or (frame, region, class name) tuples.\n\n"
      "Its trained_from says how good it is: on held_out, samples of the same kind, or cross-validated. RGB images "
      "that a "
      "file names become BT.601 in images_range. options: those of `tassilo train colors`, as closing_px.",
      "samples"_a, "held_out"_a = py::none(), "images_range"_a = ColorRange::limited, "options"_a = py::dict());
  module.def(
      "color_quality",
      [](const Colors& colors, const py::object& samples) {
        const ColorRange range = colors.file.table.range;
        const TrainingSet set = training_set(samples, range, warn_in_python);
        if (set.loaded.range && *set.loaded.range != range)
          refuse("samples", "have " + std::string(to_string(*set.loaded.range)) + " color range, must be " +
                                std::string(to_string(range)) + " as the color table");
        ColorQuality quality;
        {
          py::gil_scoped_release unlocked;
          add_quality(quality, colors.classifier, set.loaded.samples);
        }
        return figures_of(quality);
      },
      "How well a table names the pixels of samples, as train_colors takes them: precision and recall by class name;\n"
      "confusion[true, found] and overlap[true, also claimed by] in pixels, by labels 0..8.",
      "colors"_a, "samples"_a);
}

}  // namespace

void bind_color(py::module_& module) {
  bind_table(module);
  bind_segment(module);
  bind_training(module);
}

}  // namespace tassilo::python
