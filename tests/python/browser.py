"""Opens pages in a headless Chromium, Debian's package chromium of run/packages.txt.

It starts as root in a container without a network, /sys, a session bus, a home folder or shared memory. Its output goes
to files and its processes are one group, so that a process that hangs can be ended with all that it has started.
"""

import os
import shutil
import signal
import subprocess
import tempfile

PATIENCE = 300  # s for a page that takes 2 s on a quiet machine


def open_page(page, folder, *words):
    """What Chromium prints for a page with the given options, and the console lines of its scripts.
    Its profile is in a new folder below `folder`."""
    program = shutil.which("chromium")
    assert program, "chromium is not installed; it is one of the packages of run/packages.txt that tests need"
    home = tempfile.mkdtemp(prefix="chromium_", dir=folder)
    command = [program, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
               "--disable-extensions", "--disable-background-networking", f"--user-data-dir={home}/profile",
               "--enable-logging=stderr", "--host-resolver-rules=MAP * ~NOTFOUND", "--virtual-time-budget=3000",
               "--window-size=1100,3000", *words, f"file://{page}"]
    environment = os.environ | {"HOME": home, "XDG_CONFIG_HOME": home, "XDG_CACHE_HOME": home, "XDG_RUNTIME_DIR": home,
                                "DBUS_SESSION_BUS_ADDRESS": "disabled:"}
    with open(f"{home}/out", "w+") as out, open(f"{home}/err", "w+") as err:
        process = subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL, stdout=out, stderr=err,
                                   start_new_session=True)
        try:
            code = process.wait(PATIENCE)
        finally:
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            process.wait()
        out.seek(0)
        err.seek(0)
        printed, errors = out.read(), err.read()
    assert code == 0, errors
    return printed, [line for line in errors.splitlines() if ":CONSOLE" in line]
