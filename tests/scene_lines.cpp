// scene_lines COUNT: writes that many random scenes as lines.
// scene_lines: reads lines, answers each with `ok` or with what is wrong.

#include <cstdlib>
#include <iostream>
#include <string>

#include "tassilo/base/error.h"
#include "tassilo/files/internal/test_scene.h"
#include "tassilo/files/scene_json.h"

int main(int argc, char** argv) {
  if (argc > 1) {
    for (unsigned seed = 0; seed < std::strtoul(argv[1], nullptr, 10); ++seed)
      std::cout << tassilo::to_json_line(tassilo::random_scene(seed)) << "\n";
    return 0;
  }
  for (std::string line; std::getline(std::cin, line);) {
    try {
      tassilo::scene_from_json(line);
      std::cout << "ok\n";
    } catch (const tassilo::Error& error) {
      std::cout << error.what() << "\n";
    }
  }
}
