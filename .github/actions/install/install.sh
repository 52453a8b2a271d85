#!/usr/bin/env bash
# Installs Boresight in a Python environment of its own, and puts its command on the path of the job's later steps. WHEEL is the path
# of a wheel, or VERSION a version of the package; exactly one of them is set. Needs Python 3.10 or newer with venv.
set -euo pipefail

if [[ -n "$WHEEL" && -n "$VERSION" ]] || [[ -z "$WHEEL" && -z "$VERSION" ]]; then
  echo "error: expected exactly one of the inputs \`wheel\` (\"$WHEEL\") and \`version\` (\"$VERSION\")" >&2
  exit 2
fi
if [[ -n "$WHEEL" && ! -f "$WHEEL" ]]; then
  echo "error: input \`wheel\`: no file \"$WHEEL\"; expected the path of one wheel, from the top of the repository" >&2
  exit 2
fi
if [[ -n "$VERSION" && ! "$VERSION" =~ ^[0-9]+(\.[0-9A-Za-z]+)*$ ]]; then
  echo "error: input \`version\`: \"$VERSION\"; expected a version such as 0.1.0" >&2
  exit 2
fi

environment="$RUNNER_TEMP/boresight"
python3 -m venv "$environment"
"$environment/bin/pip" install --quiet "${WHEEL:-boresight==$VERSION}"
# The command alone, so that the job's own Python stays the first on the path.
mkdir -p "$environment/command"
ln -sf "$environment/bin/boresight" "$environment/command/boresight"
"$environment/command/boresight" --version
echo "$environment/command" >>"$GITHUB_PATH"
echo "program=$environment/command/boresight" >>"$GITHUB_OUTPUT"
