# What ./dev needs from the system: programs and headers, and the Debian packages that bring them.

# What a probe finds, and the Debian package that brings it.
build_needs=(g++:g++ scons:scons python3:python3 glm/glm.hpp:libglm-dev doctest/doctest.h:doctest-dev
    hidapi/hidapi.h:libhidapi-dev asio/serial_port.hpp:libasio-dev)
test_needs=(git:git clang-format:clang-format)
picture_needs=(Xvfb:xvfb)
windows_needs=(x86_64-w64-mingw32-g++-posix:g++-mingw-w64-x86-64-posix)
wine_needs=(/usr/lib/wine/wine64:wine64)
machine_needs=(qemu-system-x86_64:qemu-system-x86 busybox:busybox-static cpio:cpio)

present() { # a program, a header (its name has a slash) or a file (its path is absolute)
    local folder
    case $1 in
    /*) [[ -e $1 ]] ;;
    */*)
        for folder in /usr/include /usr/local/include /opt/homebrew/include; do
            [[ -e $folder/$1 ]] && return
        done
        return 1
        ;;
    *) command -v "$1" >/dev/null ;;
    esac
}

is_debian() { command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null; }

# fetch_once PATH WHAT COMMAND...: runs the command unless the path is there; one process of this user at a time
fetch_once() {
    [[ ! -e $1 ]] || return 0
    mkdir -p "$cache"
    (
        flock 9
        [[ ! -e $1 ]] || exit 0
        echo "dev: fetching $2 into $cache"
        "${@:3}"
    ) 9>"$cache/lock"
}

need() { # need PROBE:PACKAGE...
    local entry missing=() packages=()
    for entry in "$@"; do
        present "${entry%%:*}" && continue
        missing+=("${entry%%:*}")
        packages+=("${entry#*:}")
    done
    ((${#missing[@]})) || return 0
    is_debian || die "missing: ${missing[*]}. Install them (Debian calls them ${packages[*]})."
    if ((EUID != 0)); then
        echo "dev: missing: ${missing[*]}. Run as root:" >&2
        echo "apt-get update && apt-get install -y --no-install-recommends ${packages[*]}"
        exit 1
    fi
    echo "dev: installing ${packages[*]}"
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
        "${packages[@]}" >/dev/null
}

# The newer clang-tidy takes half of the older one's time. After the other packages: by then apt knows what there is.
need_tidy() {
    present clang-tidy-22 && return
    ((EUID == 0)) || ! present clang-tidy || return 0
    if is_debian && apt-cache show clang-tidy-22 >/dev/null 2>&1; then
        need clang-tidy-22:clang-tidy-22
    else
        need clang-tidy:clang-tidy
    fi
}
