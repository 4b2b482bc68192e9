# SPDX-License-Identifier: GPL-2.0-or-later
from pathlib import Path

from spack.package import *


class Calendem(CMakePackage):
    """Calendering of battery electrodes: a LIGGGHTS plugin and the command line around it."""

    # The checkout that this recipe lies in; what is not committed is not built.
    git = str(Path(__file__).resolve().parents[5])
    license("GPL-2.0-or-later")

    version("main", branch="main")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    generator("ninja")
    conflicts("%gcc@:8", msg="std::filesystem is not in libstdc++ before GCC 9")

    depends_on("mpi", type=("build", "link", "run"))
    depends_on("vtk@9.0:+mpi")
    depends_on("boost+math")
    depends_on("cli11@2:")
    depends_on("eigen@3.4:3")
    depends_on("fmt@9:")
    depends_on("libpng")
    depends_on("libtiff")
    depends_on("minizip")
    depends_on("nlopt")
    depends_on("itk@5:")
    depends_on("nlohmann-json@3.11:")
    depends_on("openssl")
    depends_on("tomlplusplus@3:")

    resource(
        name="liggghts",
        git="https://github.com/CFDEMproject/LIGGGHTS-PUBLIC",
        commit="3d5c00f20519e6bb6eb6756f51f1ad36564e649d",
        placement="liggghts",
    )
    # The reports embed three.js; r111 is the version of Debian 12.
    resource(
        name="three",
        url="https://raw.githubusercontent.com/mrdoob/three.js/r111/build/three.min.js",
        sha256="cd0bb6c699acc574c48ded9499338e69d00c4029bae6512b669b5db74dd8fea6",
        expand=False,
        placement="three",
    )
    resource(
        name="orbit-controls",
        url="https://raw.githubusercontent.com/mrdoob/three.js/r111/examples/js/controls/OrbitControls.js",
        sha256="6e83de3bc8156ad002b92bbc9620eec76418d3495458acb5a831cc7227a1b094",
        expand=False,
        placement="orbit-controls",
    )
    # ... and d3, 3.5.17 there too.
    resource(
        name="d3",
        url="https://raw.githubusercontent.com/d3/d3/v3.5.17/d3.min.js",
        sha256="b81e673dc58af2faf97bcdec9eab4c5182769ffe536773d5f42091935a73a1be",
        expand=False,
        placement="d3",
    )

    @run_before("cmake")
    def prepare_sources(self):
        with working_dir(self.stage.source_path):
            Executable("tools/get-liggghts")("--source", "liggghts", "-o", "build/host")
            mkdirp("three/examples/js/controls")
            copy("orbit-controls/OrbitControls.js", "three/examples/js/controls")

    def cmake_args(self):
        source = Path(self.stage.source_path)
        return [
            self.define("CALENDEM_HOST_DIR", source / "build/host"),
            self.define("CALENDEM_THREE_DIR", source / "three"),
            self.define("CALENDEM_D3_DIR", source / "d3"),
            self.define("CALENDEM_TUNE", False),  # spack's compiler wrappers tune for the target
            self.define("BUILD_TESTING", False),
        ]
