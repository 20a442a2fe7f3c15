"""Builds the core for the cores it is meant for, and reads sizes and stacks out of what the
compiler says. Used by size.py and test_static.py; nothing is run."""
import hashlib
import os
import re
import shutil
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# name: prefix of the tools, options
TARGETS = {
    "m0plus": ("arm-none-eabi-", ["-mcpu=cortex-m0plus", "-mthumb"]),
    "m3": ("arm-none-eabi-", ["-mcpu=cortex-m3", "-mthumb"]),
    "rv32imc": ("riscv64-unknown-elf-", ["-march=rv32imc", "-mabi=ilp32"]),
}
PACKAGES = {"arm-none-eabi-": "gcc-arm-none-eabi", "riscv64-unknown-elf-": "gcc-riscv64-unknown-elf"}
LEVELS = ("-Os", "-O2")

# What a firmware may link: the headers whose functions it calls, the layers it builds, -D options.
PARTS = ["SHADING", "FOG", "BLENDS", "CUTOUTS", "BILINEAR", "MIPS", "WRAPS", "TEXTURE_FORMATS", "TARGET_FORMATS", "DITHER"]
LOOPS = ["FLAT", "GOURAUD", "NO_DEPTH", "KEYED", "LIT", "BILINEAR", "GREY4"]
NO_LOOPS = [f"-DEW_WITH_LOOP_{loop}=0" for loop in LOOPS]
NO_FILLS = [f"-DEW_WITH_{part}=0" for part in PARTS] + NO_LOOPS
RASTER, GEOMETRY = ("fixed", "src/raster"), ("fixed", "src/raster", "src/geometry")
CONFIGURATIONS = {
    "textured, depth": (("raster",), RASTER, NO_FILLS),
    "the same with transform": (("raster", "geometry"), GEOMETRY, NO_FILLS),
    "raster, all fills, loops left out": (("raster",), RASTER, NO_LOOPS),
    "raster, all fills": (("raster",), RASTER, []),
    "the same with transform and light": (("raster", "geometry", "light"), GEOMETRY, []),
    "textured, depth, in bands and lines": (("raster", "geometry", "picture"), GEOMETRY, NO_FILLS),
    "everything, with scenes": (("fixed", "raster", "draw2d", "geometry", "picture", "light", "scene", "error"),
                                GEOMETRY + ("src/scene",), []),
    "display, device side": (("display",), ("fixed", "src/display"), []),
}


def missing(target):
    """Why a target cannot be built for, or None."""
    prefix = TARGETS[target][0]
    return None if shutil.which(prefix + "gcc") else f"no {prefix}gcc (Debian: {PACKAGES[prefix]})"


def run(command, **options):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, **options).stdout


def sources(root, layers):
    for layer in layers:
        folder = os.path.join(root, layer)
        for name in sorted(os.listdir(folder)):
            if name.endswith(".c"):
                yield os.path.join(layer, name)


def newest(root):
    """The youngest of all that an object depends on."""
    stamps = [os.path.getmtime(os.path.join(path, name)) for folder in ("include", "fixed", "src")
              for path, _, names in os.walk(os.path.join(root, folder)) for name in names]
    return max(stamps + [os.path.getmtime(os.path.abspath(__file__))])


def build(target, level, layers, defines, out, root=ROOT):
    """Objects, with the compiler's call graph and frames beside them (.ci)."""
    prefix, flags = TARGETS[target]
    folder = os.path.join(out, target + level + ("-" + hashlib.sha1("".join(defines).encode()).hexdigest()[:8] if defines else ""))
    os.makedirs(folder, exist_ok=True)
    changed, objects = newest(root), []
    for path in sources(root, layers):
        made = os.path.join(folder, path.replace("/", "_")[:-2] + ".o")
        objects.append(made)
        if os.path.exists(made) and os.path.getmtime(made) > changed:
            continue
        run([prefix + "gcc", *flags, level, "-std=c99", "-ffreestanding", "-ffunction-sections", "-fdata-sections",
             "-fstack-usage", "-fcallgraph-info=su,da", *defines, "-Iinclude", "-c", path, "-o", made], cwd=root)
    return objects


# ---- sizes ----

def public_functions(headers, root=ROOT):
    found = set()
    for header in headers:
        with open(os.path.join(root, "include/edgewalk", header + ".h"), encoding="utf-8") as f:
            text = re.sub(r"/\*.*?\*/", "", f.read(), flags=re.S)
        text = re.sub(r"#if EW_TRACE.*?#endif", "", text, flags=re.S)
        found |= set(re.findall(r"^(?!static)[a-z][\w *]*?\b(ew_\w+)\([^{};]*\);", text, re.M))
    return found


def defined(objects, prefix):
    """Functions that the objects define, with external linkage."""
    return {line.split()[-1] for line in run([prefix + "nm", "--defined-only", "-g", *objects]).splitlines()
            if " T " in line}


def object_size(path, prefix):
    text, data, bss = run([prefix + "size", path]).splitlines()[1].split()[:3]
    return int(text), int(data), int(bss)


def linked_size(target, objects, roots, out):
    """Bytes of text, data and bss of what the roots pull in, the compiler's helpers apart."""
    prefix, flags = TARGETS[target]
    image = os.path.join(out, "linked.elf")
    keep = [f"-Wl,-u,{name}" for name in sorted(roots)] + ["-Wl,--defsym,memcpy=0,--defsym,memset=0"] # the firmware has them
    run([prefix + "gcc", *flags, "-nostartfiles", "-nostdlib", "-Wl,--gc-sections", f"-Wl,-e,{sorted(roots)[0]}", *keep,
         *objects, "-lgcc", "-o", image])
    text, data, bss = object_size(image, prefix)
    own = {line.split()[-1] for line in run([prefix + "nm", "--defined-only", *objects]).splitlines() if len(line.split()) == 3}
    helpers = 0
    for line in run([prefix + "nm", "-S", "--defined-only", image]).splitlines():
        words = line.split()
        if len(words) == 4 and words[2] in "tTrRwW" and words[3] not in own:
            helpers += int(words[1], 16)
    return text, data, bss, helpers


# ---- stacks ----

# A helper of the compiler's library: no call graph of it is at hand. Read from its machine code: the
# deepest of those allowed, ARMv6-M's __aeabi_lmul, saves 28 bytes; most none.
HELPER_FRAME = 40
HELPERS = re.compile(r"__aeabi_(lmul|llsl|llsr|lasr|u?idiv(mod)?|u?ldivmod|lcmp|ulcmp|idiv0|ldiv0)|__clz[sd]i2|"
                     r"__(mul|ashl|ashr|lshr|u?div|u?mod|u?cmp)[sd]i[23]|__gnu_thumb1_case_\w+|memcpy|memset|__riscv_\w+")


# The only sources that call through a pointer, and what those calls may reach; callbacks of
# the display's and the picture's are the firmware's own and not counted.
INDIRECT = {
    "src/scene/scene.c": [f"src/scene/scene.c:{kind}_ok" for kind in
                          ("node", "primitive", "material", "texture", "track", "key")],
    "src/display/hid_display.c": [],
    "src/geometry/picture.c": [],
}


class StackError(Exception):
    pass


class Stacks:
    """The call graph of some objects, from their .ci files (VCG text)."""

    def __init__(self, objects):
        self.frame, self.calls, self.memo = {}, {}, {}
        for path in objects:
            with open(path[:-2] + ".ci", encoding="utf-8") as f:
                self.read(f.read())

    def read(self, text):
        for title, label in re.findall(r'node: \{ title: "([^"]+)" label: "([^"]*)"', text):
            frame = re.search(r"(\d+) bytes \((\w+)", label)
            if frame:
                if frame.group(2) != "static":
                    raise StackError(f"{title}: a frame of no fixed size ({frame.group(2)})")
                self.frame[title] = int(frame.group(1))
        source = re.search(r'graph: \{ title: "([^"]+)"', text).group(1)
        for caller, callee in re.findall(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"', text):
            self.calls.setdefault(caller, set()).update(
                INDIRECT.get(source, [callee]) if callee == "__indirect_call" else [callee])

    def depth(self, name, path=()):
        """(bytes, chain) of the deepest calls from `name`."""
        if name in path:
            raise StackError("recursion: " + " > ".join(path[path.index(name):] + (name,)))
        if name == "__indirect_call":
            raise StackError(f"indirect call in {path[-1]}")
        if name not in self.memo:
            if name not in self.frame:
                if not HELPERS.fullmatch(name):
                    raise StackError(f"{path[-1]} calls {name}, which is neither ours nor a known helper")
                return HELPER_FRAME, (name,)
            deepest = max((self.depth(callee, path + (name,)) for callee in sorted(self.calls.get(name, ()))),
                          default=(0, ()))
            self.memo[name] = self.frame[name] + deepest[0], (name.split(":")[-1],) + deepest[1]
        return self.memo[name]

    def all(self):
        """Every function's depth: a cycle has no root, so each is asked."""
        return {name: self.depth(name) for name in self.frame}
