"""The short slope over the variation of its cohesion and its vertical scale of fluctuation.

    python workflows/2_sweep.py

writes reports/sweep.md with its picture. Stopped, the same command continues in results/short_slope_sweep. It does what
this line does:

    rfmpm sweep configs/short_slope_random.toml \\
        --vary random_field.cohesion.coefficient_of_variation=0.1,0.25,0.4 \\
        --vary theta_v:random_field.cohesion.scale_of_fluctuation_v_m,random_field.cohesion.scale_of_fluctuation_h_m=\\
0.5:3,1:6,2:12 --realisations 64
"""

import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "results" / "short_slope_sweep"
FIELD = "random_field.cohesion"
VARIATIONS = (0.1, 0.25, 0.4)
VERTICAL_SCALES = (0.5, 1.0, 2.0)  # [m]
ANISOTROPY = 6.0  # horizontal over vertical scale of fluctuation
REALISATIONS = 64


def main() -> None:
    """Run or continue the sweep, and copy its page to the reports."""
    scales = ",".join(f"{scale:g}:{ANISOTROPY * scale:g}" for scale in VERTICAL_SCALES)
    command = [
        *(sys.executable, "-c", "from rfmpm.cli import main; main()", "sweep"),
        str(ROOT / "configs" / "short_slope_random.toml"),
        *("--vary", f"{FIELD}.coefficient_of_variation={','.join(map(str, VARIATIONS))}"),
        *("--vary", f"theta_v:{FIELD}.scale_of_fluctuation_v_m,{FIELD}.scale_of_fluctuation_h_m={scales}"),
        *("--realisations", str(REALISATIONS), "--out", str(FOLDER)),
    ]
    subprocess.run(command, check=True)
    shutil.copy(FOLDER / "sweep.png", ROOT / "reports")
    title, rest = (FOLDER / "sweep.md").read_text("utf-8").split("\n", 1)
    page = f"{title}\n\n`python workflows/2_sweep.py` wrote this.\n{rest}"
    (ROOT / "reports" / "sweep.md").write_text(page, "utf-8")


if __name__ == "__main__":
    main()
