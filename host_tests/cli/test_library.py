"""The freestanding library: what it asks of its surroundings, and what it keeps."""
import os
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
LIBRARY = os.path.join(os.path.dirname(os.environ.get("EW_BIN", "build/release/bin")), "libedgewalk.a")
AEABI = r"__aeabi_(u?idiv(mod)?|u?ldivmod|lmul|llsl|llsr|lasr|u?lcmp)|__clzsi2"  # integers only
CROSS = [("arm-none-eabi-", ["-mcpu=cortex-m0plus", "-mthumb"], AEABI + r"|__gnu_thumb1_\w+"),
         ("arm-none-eabi-", ["-mcpu=cortex-m3", "-mthumb"], AEABI),
         ("riscv64-unknown-elf-", ["-march=rv32imc", "-mabi=ilp32"], r"__\w+[sd]i\d"),
         ("avr-", ["-mmcu=atmega2560"], r"__(?!\w*[sd]f)\w+|memmove")]  # where int has 16 bits


def symbols(archive, nm="nm"):
    """(kind, name) of all symbols, and the set of those that no member defines."""
    text = subprocess.run([nm, archive], check=True, stdout=subprocess.PIPE, text=True).stdout
    found = [line.split()[-2:] for line in text.splitlines() if re.search(r" [A-Za-z] \w+$", line)]
    defined = {name for kind, name in found if kind != "U"}
    return found, {name for kind, name in found if kind == "U"} - defined


def sources(*folders):
    for folder in folders:
        for path, _, names in os.walk(os.path.join(ROOT, folder)):
            for name in sorted(names):
                if name.endswith((".c", ".h")):
                    yield os.path.join(path, name)


class Library(unittest.TestCase):
    def test_needs_only_memcpy_and_memset(self):
        self.assertLessEqual(symbols(os.path.join(ROOT, LIBRARY))[1], {"memcpy", "memset"})

    def test_has_no_mutable_globals(self):
        # Name|Value|Class|Type|Size|Line|Section; a constant that holds an address is in .data.rel.ro
        text = subprocess.run(["nm", "-f", "sysv", os.path.join(ROOT, LIBRARY)], check=True, stdout=subprocess.PIPE, text=True).stdout
        rows = [[cell.strip() for cell in line.split("|")] for line in text.splitlines() if line.count("|") == 6]
        self.assertIn("T", {row[2] for row in rows})
        self.assertEqual({(row[2], row[0]) for row in rows if row[2] in "dDbBcCsS" and row[2]
                          and not row[6].startswith(".data.rel.ro")}, set())

    def test_external_names_have_the_prefix(self):
        names = {name for kind, name in symbols(os.path.join(ROOT, LIBRARY))[0] if kind in "TRDB"}
        self.assertEqual({name for name in names if not name.startswith("ew_")}, set())

    def test_names_no_float_and_no_host_header(self):
        allowed = {"stddef.h", "stdint.h", "limits.h"}  # those that a freestanding compiler has
        for path in sources("fixed", "src", "include"):
            with open(path, encoding="utf-8") as source:
                text = re.sub(r"/\*.*?\*/", "", source.read(), flags=re.S)
            with self.subTest(path=os.path.relpath(path, ROOT)):
                self.assertIsNone(re.search(r"\b(float|double|malloc|free|printf)\b", text))
                self.assertLessEqual(set(re.findall(r"#include <([^>]+)>", text)), allowed)

    def test_arrows_point_one_way(self):
        """A file includes public headers of its own layer and those below it only."""
        below = {"fixed": {"config", "error", "fixed"}}
        below["src/raster"] = below["fixed"] | {"draw2d", "raster", "raster_work"}
        below["src/geometry"] = below["src/raster"] | {"geometry", "light", "picture"}
        below["src/scene"] = below["src/geometry"] | {"scene"}
        below["src/display"] = {"config", "error", "display", "panel"}
        for folder, allowed in below.items():
            for path in sources(folder):
                with open(path, encoding="utf-8") as source:
                    included = re.findall(r'#include "([^"]+)"', source.read())
                with self.subTest(path=os.path.relpath(path, ROOT)):
                    for name in included:
                        public = re.fullmatch(r"edgewalk/(\w+)\.h", name)
                        if public:
                            self.assertIn(public.group(1), allowed)
                        else:
                            self.assertNotIn("/", name)  # private headers lie beside their sources

    def test_cpp_programs_link_with_it(self):
        with open(os.path.join(ROOT, "include/edgewalk/edgewalk.h"), encoding="utf-8") as source:
            self.assertEqual(set(re.findall(r'#include "(\w+\.h)"', source.read())),
                             {name for name in os.listdir(os.path.join(ROOT, "include/edgewalk"))
                              if name not in ("edgewalk.h", "picture_work.h", "raster_work.h")})
        names = {"ew_error_text", "ew_raster_init", "ew_geometry_init", "ew_lighting_set", "ew_picture_draw", "ew_scene_open",
                 "ew_draw_text", "ew_mat44_perspective", "ew_hid_display_init", "ew_pack_rgb444"}
        text = "#include <cstdio>\n#include <edgewalk/edgewalk.h>\n"
        for i, name in enumerate(sorted(names)):
            text += f"void (*volatile f{i})() = reinterpret_cast<void (*)()>({name});\n"
        text += "int main() { std::puts(ew_error_text(EW_ERR_ROOM)); }\n"
        with tempfile.TemporaryDirectory() as folder:
            for standard in ("c++11", "c++17", "c++20"):
                program = os.path.join(folder, standard)
                subprocess.run(["g++", f"-std={standard}", "-Wall", "-Wextra", "-Werror", "-Iinclude", "-x", "c++", "-", "-x", "none",
                                os.path.join(ROOT, LIBRARY), "-o", program], input=text, text=True, check=True, cwd=ROOT)
                self.assertEqual(subprocess.run([program], check=True, stdout=subprocess.PIPE, text=True).stdout,
                                 "not enough memory given\n")

    def test_cross_builds_need_only_compiler_helpers(self):
        built = 0
        for prefix, flags, helpers in CROSS:
            if not shutil.which(prefix + "gcc"):
                continue
            for level in ("-O0", "-Os", "-O2"):
                folder = os.path.join(ROOT, os.path.dirname(LIBRARY), "cross", "".join(flags).replace("=", "-") + level)
                os.makedirs(folder, exist_ok=True)
                with self.subTest(flags=flags, level=level):
                    objects = []
                    for path in sources("fixed", "src"):
                        if path.endswith(".h"):
                            continue
                        objects.append(os.path.join(folder, os.path.relpath(path, ROOT).replace("/", "_") + ".o"))
                        subprocess.run([prefix + "gcc", *flags, level, "-std=c99", "-pedantic", "-ffreestanding", "-Wall",
                                        "-Wextra", "-Wconversion", "-Werror", "-Iinclude", "-c", path, "-o", objects[-1]],
                                       check=True, cwd=ROOT)
                    archive = os.path.join(folder, "all.a")
                    if os.path.exists(archive):
                        os.remove(archive)
                    subprocess.run([prefix + "ar", "rcs", archive, *objects], check=True)
                    missing = symbols(archive, prefix + "nm")[1]
                    self.assertEqual({n for n in missing if n not in ("memcpy", "memset")
                                      and not re.fullmatch(helpers, n)}, set())
                    built += 1
        if not built:
            self.skipTest("no cross compiler (Debian: gcc-arm-none-eabi, gcc-riscv64-unknown-elf, gcc-avr)")


if __name__ == "__main__":
    unittest.main()
