"""A run needs only what its plan asks for."""

import subprocess
import sys


def test_a_launcher_imports_no_opencv_and_no_rich() -> None:
    program = "import sys, fwk.launcher.run; print(*{'cv2', 'rich', 'scipy'}.intersection(sys.modules))"
    assert subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True).stdout == "\n"
