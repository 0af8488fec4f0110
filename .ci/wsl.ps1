# Runs the quick tests in WSL2, in a new Debian with a clone of this folder. Called by workflows on Windows; changes the machine.
$ErrorActionPreference = "Stop"
$env:WSL_UTF8 = "1"

# In-Wsl COMMAND: a command line of bash there, as root; ends this script if it fails.
function In-Wsl([string] $command) {
    wsl --distribution Debian --user root --exec bash -ec $command
    if ($LASTEXITCODE -ne 0) { exit $LASTEXITCODE }
}

wsl --set-default-version 2
wsl --install --distribution Debian --no-launch
if ($LASTEXITCODE -ne 0) { exit $LASTEXITCODE }
In-Wsl "grep -i microsoft-standard-WSL2 /proc/version"
In-Wsl "apt-get update -qq && apt-get install -y -qq --no-install-recommends git ca-certificates"
# This folder is the current one there, too, as one of Windows. Its owner is another user.
In-Wsl "git config --global --add safe.directory '*' && rm -rf ~/pogosim && git clone --quiet . ~/pogosim"
In-Wsl "cd ~/pogosim && ./test.sh --quick"
