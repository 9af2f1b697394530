"""check_floors.py finds each kind of fault in a toy tree, and nothing in a right one."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tools"))
import check_floors  # noqa: E402

HEADER = "#pragma once\n"


class CheckFloors(unittest.TestCase):
    def faults(self, files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text, encoding="utf-8")
            return check_floors.faults_in(root)[0]

    def test_accepts_lower_floors_own_libraries_and_comments(self):
        self.assertEqual([], self.faults({
            "region/region.h": HEADER + "#include <vector>\n#include <Eigen/Core>\n#include \"tassilo/image/frame.h\"\n",
            "region/region.cpp": '#include "tassilo/region/region.h"\n#include "tassilo/region/internal/runs.h"\n',
            "region/region_test.cpp": "#include <gtest/gtest.h>\n#include <opencv2/imgproc.hpp>\n",
            "files/camera_file.h": HEADER + '// not YAML::Node; #include "tassilo/app/run.h"\n',
            "files/camera_file.cpp": '#include "tassilo/files/camera_file.h"\n#include <yaml-cpp/yaml.h>\n',
            "evaluate/score.cpp": '#include "tassilo/files/scene_json.h"\n',
            "source/internal/test_clip.h": HEADER + "#include <gtest/gtest.h>\n",
            "app/commands.h": HEADER + "#include <CLI/CLI.hpp>\n",
            "app/main.cpp": "#include <CLI/CLI.hpp>\nvoid f() { std::cout << 1; }\n",
        }))

    def test_refuses(self):
        cases = {
            "up": ("region/a.cpp", '#include "tassilo/scene/scene.h"\n', "may not include scene"),
            "sideways": ("vision/a.cpp", '#include "tassilo/evaluate/score.h"\n', "may not include evaluate"),
            "up from a test": ("region/a_test.cpp", '#include "tassilo/vision/vision.h"\n', "may not include vision"),
            "door to door": ("record/a.cpp", '#include "tassilo/source/source.h"\n', "may not include source"),
            "part on no floor": ("misc/a.cpp", "", "is on no floor"),
            "unknown part": ("app/a.cpp", '#include "tassilo/misc/a.h"\n', "is on no floor"),
            "another part's internals": ("color/a.cpp", '#include "tassilo/region/internal/a.h"\n', "internal to region"),
            "internals in public": ("color/a.h", HEADER + '#include "tassilo/color/internal/a.h"\n', "shows"),
            "library of another part": ("vision/a.cpp", "#include <nlohmann/json.hpp>\n", "may not include <nlohmann"),
            "library in the core": ("region/a.cpp", "#include <opencv2/imgproc.hpp>\n", "may not include <opencv2"),
            "Eigen on floor 0": ("base/a.cpp", "#include <Eigen/Core>\n", "may not include <Eigen"),
            "library in a public header": ("files/a.h", HEADER + "#include <png.h>\n", "public headers may not include"),
            "forward declaration": ("source/a.h", HEADER + "struct AVFrame;\n", "shows AVFrame"),
            "relative include": ("region/a.cpp", '#include "runs.h"\n', "must be a path"),
            "no pragma once": ("region/a.h", "#include <vector>\n", "pragma once"),
            "using namespace": ("region/a.h", HEADER + "using namespace std;\n", "using namespace"),
            "printing": ("vision/a.cpp", 'void f() { std::fprintf(stderr, "x"); }\n', "print"),
            "exit": ("files/a.cpp", "void f() { exit(1); }\n", "exit"),
        }
        for name, (path, text, expected) in cases.items():
            with self.subTest(name):
                faults = self.faults({path: text})
                self.assertEqual(1, len(faults), faults)
                self.assertIn(expected, faults[0])

    def test_refuses_a_source_that_includes_its_own_header_late(self):
        faults = self.faults({"region/a.h": HEADER, "region/a.cpp": '#include <vector>\n#include "tassilo/region/a.h"\n'})
        self.assertEqual(["region/a.cpp: must include tassilo/region/a.h first"], faults)


if __name__ == "__main__":
    unittest.main()
