#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tassilo/color/color_class.h"
#include "tassilo/geometry/box.h"
#include "tassilo/image/frame.h"
#include "tassilo/region/components.h"

// What all binding files share: how small values look in Python, how arrays are checked, and how functions are bound.
//
// Python code must never be able to stop the interpreter. So whatever the library takes for granted (`expects`) is
// checked here first: `refuse` raises ValueError with what it is and what it must be. Errors of the outside world stay
// tassilo.Error.

namespace tassilo::python {

namespace py = pybind11;
using namespace py::literals;

void bind_region(py::module_& module);
void bind_features(py::module_& module);
void bind_contour(py::module_& module);
void bind_image(py::module_& module);
void bind_color(py::module_& module);
void bind_camera(py::module_& module);
void bind_vision(py::module_& module);

/// Raises ValueError("NAME REASON"); the reason says "is ..., must be ...".
[[noreturn]] inline void refuse(const std::string& name, const std::string& reason) {
  throw py::value_error(name + " " + reason);
}

/// An argument that may be an array or whatever numpy makes one of.
struct ArrayLike {
  py::array array;
};

/// "(480, 640, 3) of uint8"
std::string shown(const py::array& array);

/// Binds a function that works without Python: `check` gets the arguments first, then the interpreter's lock is given
/// up while the function runs.
template <class Result, class... Arguments, class Check, class... Extra>
void def(py::module_& module, const char* name, Result (*function)(Arguments...), Check check, const Extra&... extra) {
  module.def(
      name,
      [function, check](Arguments... arguments) {
        check(arguments...);
        py::gil_scoped_release unlocked;
        return function(arguments...);
      },
      extra...);
}
/// The check of functions that take any arguments.
inline constexpr auto kAnything = [](const auto&...) {};

/// An array that takes over a vector's memory.
template <class T>
py::array_t<T> array_of(std::vector<T> values, std::vector<py::ssize_t> shape) {
  auto* owned = new std::vector<T>(std::move(values));
  const py::capsule owner(owned, [](void* vector) { delete static_cast<std::vector<T>*>(vector); });
  return py::array_t<T>(std::move(shape), owned->data(), owner);
}

/// A look at memory that `owner` keeps; nobody can write through it.
template <class T>
py::array_t<T> view_of(const T* data, std::vector<py::ssize_t> shape, py::handle owner) {
  py::array_t<T> view(std::move(shape), data, owner);
  py::detail::array_proxy(view.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return view;
}

/// (N, 2) of column, row.
template <class Points>
py::array_t<double> array_of_points(const Points& points) {
  std::vector<double> numbers;
  numbers.reserve(2 * points.size());
  for (const auto& point : points) numbers.insert(numbers.end(), {point.x, point.y});
  return array_of(std::move(numbers), {static_cast<py::ssize_t>(points.size()), 2});
}

/// What an argument that may be several things is; raises TypeError("NAME is a TYPE, must be MUST") when it is not.
template <class T>
T as(const char* name, py::handle argument, const char* must) {
  try {
    return argument.cast<T>();
  } catch (const py::cast_error&) {
    throw py::type_error(std::string(name) + " is a " + Py_TYPE(argument.ptr())->tp_name + ", must be " + must);
  }
}

/// The value that a word stands for.
template <class T>
T choice(const char* name, const std::string& word, std::initializer_list<std::pair<const char*, T>> choices) {
  std::string words;
  for (const auto& [known, value] : choices) {
    if (word == known) return value;
    words.append(words.empty() ? "" : ", ").append(known);
  }
  refuse(name, "is '" + word + "', must be one of " + words);
}

}  // namespace tassilo::python

namespace pybind11::detail {

/// Values that Python writes as one of a few names.
template <class T, std::size_t N>
std::optional<T> value_of_name(handle source, const std::array<T, N>& values, const char* what) {
  if (!isinstance<str>(source)) return std::nullopt;
  const auto name = source.cast<std::string>();
  std::string names;
  for (const T value : values) {
    if (name == to_string(value)) return value;
    names.append(names.empty() ? "" : ", ").append(to_string(value));
  }
  throw value_error(std::string(what) + " is '" + name + "', must be one of " + names);
}

template <>
struct type_caster<tassilo::python::ArrayLike> {
  PYBIND11_TYPE_CASTER(tassilo::python::ArrayLike, const_name("ArrayLike"));
  bool load(handle source, bool) {
    value.array = array::ensure(source);
    return static_cast<bool>(value.array);
  }
};

template <>
struct type_caster<tassilo::ColorRange> {
  PYBIND11_TYPE_CASTER(tassilo::ColorRange, const_name("Literal['limited', 'full']"));
  bool load(handle source, bool) {
    using Range = tassilo::ColorRange;
    const auto found = value_of_name(source, std::array{Range::limited, Range::full}, "color range");
    if (found) value = *found;
    return found.has_value();
  }
  static handle cast(tassilo::ColorRange range, return_value_policy, handle) {
    return str(std::string(to_string(range))).release();
  }
};

template <>
struct type_caster<tassilo::ColorClass> {
  PYBIND11_TYPE_CASTER(tassilo::ColorClass, const_name("str"));
  bool load(handle source, bool) {
    std::array<tassilo::ColorClass, tassilo::kColorClassCount + 1> all{};
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<tassilo::ColorClass>(k);
    const auto found = value_of_name(source, all, "color class");
    if (found) value = *found;
    return found.has_value();
  }
  static handle cast(tassilo::ColorClass color, return_value_policy, handle) {
    return str(std::string(to_string(color))).release();
  }
};

template <>
struct type_caster<tassilo::Connectivity> {
  PYBIND11_TYPE_CASTER(tassilo::Connectivity, const_name("Literal[4, 8]"));
  bool load(handle source, bool) {
    if (!PyIndex_Check(source.ptr())) return false;
    const auto neighbors = reinterpret_steal<object>(PyNumber_Index(source.ptr()));
    if (!neighbors) throw error_already_set();
    const bool is_four = neighbors.equal(int_(4));
    if (!is_four && !neighbors.equal(int_(8)))
      throw value_error("connectivity is " + str(neighbors).cast<std::string>() + ", must be 4 or 8");
    value = is_four ? tassilo::Connectivity::four : tassilo::Connectivity::eight;
    return true;
  }
  static handle cast(tassilo::Connectivity connectivity, return_value_policy, handle) {
    return int_(connectivity == tassilo::Connectivity::four ? 4 : 8).release();
  }
};

/// (x0, y0, x1, y1), ends exclusive.
template <>
struct type_caster<tassilo::PixelBox> {
  PYBIND11_TYPE_CASTER(tassilo::PixelBox, const_name("Tuple[int, int, int, int]"));
  bool load(handle source, bool) {
    if (!isinstance<sequence>(source) || isinstance<str>(source) || len(source) != 4) return false;
    std::array<int, 4> ends{};
    for (std::size_t k = 0; k < 4; ++k) {
      const object item = reinterpret_borrow<sequence>(source)[k];
      if (!PyIndex_Check(item.ptr())) return false;
      const auto number = reinterpret_steal<object>(PyNumber_Index(item.ptr()));
      if (!number) throw error_already_set();
      int overflow = 0;
      const long end = PyLong_AsLongAndOverflow(number.ptr(), &overflow);
      if (overflow != 0 || end < -1'000'000'000 || end > 1'000'000'000)
        throw value_error("a box end is " + str(number).cast<std::string>() + ", must be within +-1e9");
      ends[k] = static_cast<int>(end);
    }
    value = {ends[0], ends[1], ends[2], ends[3]};
    return true;
  }
  static handle cast(const tassilo::PixelBox& box, return_value_policy, handle) {
    return pybind11::make_tuple(box.x0, box.y0, box.x1, box.y1).release();
  }
};

}  // namespace pybind11::detail
