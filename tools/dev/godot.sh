# Which Godot is used: $GODOT, one on PATH, or a private copy of Debian's under the user's cache.

minimum_godot=4.4
godot_suite=forky # the first Debian suite with Godot 4
copy=$cache/godot
copy_version=2    # of the way the copy is made; a copy of another version is made anew

new_enough() { # is this program a Godot of minimum_godot or later?
    local version
    version=$("$1" --headless --version 2>/dev/null | tail -n 1) || return 1
    [[ $version =~ ^([0-9]+)\.([0-9]+) ]] || return 1
    local have=$((BASH_REMATCH[1] * 1000 + BASH_REMATCH[2]))
    ((have >= ${minimum_godot%.*} * 1000 + ${minimum_godot#*.}))
}

# Sets and exports GODOT.
find_godot() {
    local name
    if [[ -n ${GODOT:-} ]]; then
        new_enough "$GODOT" || die "GODOT=$GODOT: not a Godot $minimum_godot or later"
        GODOT=$(realpath "$(command -v "$GODOT")")
        export GODOT
        return
    fi
    for name in godot godot4; do
        if command -v "$name" >/dev/null && new_enough "$name"; then
            GODOT=$(command -v "$name")
            export GODOT
            return
        fi
    done
    copy_is_ready || make_copy
    # Debian's fontconfig looks in /etc/fonts; what the editor starts inherits this.
    [[ -e /etc/fonts/fonts.conf ]] || export FONTCONFIG_PATH=$copy/root/etc/fonts
    export GODOT=$copy/godot
}

run_godot() { # ./dev godot: in the folder of the caller
    find_godot
    cd "$caller"
    exec "$GODOT" "$@"
}

# --- The private copy ------------------------------------------------------------------------------
# Debian's own Godot with all its libraries, its C library included, unpacked without root; nothing of the system
# changes. Its program is patched to use that C library's loader and those libraries, so that it is a program like any
# other: the editor starts it again to run a game. The loader's path must be absolute, hence belongs to one place: the
# file $copy/made says which place that is, and is written when the copy is whole.

copy_is_ready() { [[ -x $copy/godot && $(cat "$copy/made" 2>/dev/null) == "$copy_version $copy" ]]; }

make_copy() {
    is_debian || die "Godot $minimum_godot or later is needed: put godot on PATH or set GODOT"
    if ! mkdir -p "$cache" 2>/dev/null || [[ ! -w $cache ]]; then
        die "$cache: cannot write there; set XDG_CACHE_HOME to a folder of your own"
    fi
    (
        flock 9
        copy_is_ready && exit 0
        if [[ $(cut -d' ' -f1 "$copy/made" 2>/dev/null) == "$copy_version" ]]; then
            echo "dev: patching the private Godot for its place, $copy"
        else
            echo "dev: no Godot $minimum_godot or later here; fetching a private one into $cache"
            fetch_copy "$cache/godot.part"
            rm -rf "$copy"
            mv "$cache/godot.part/copy" "$copy"
            rm -rf "$cache/godot.part"
        fi
        settle_copy
    ) 9>"$cache/lock"
}

# The mirror that this machine installs its own packages from.
debian_mirror() {
    # shellcheck disable=SC2016 # the $(NAMES) are apt's
    apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
        awk '$2 !~ /security|updates|backports/ && $1 !~ /security/ && $3 == "main" \
             && $1 ~ /debian/ {print $1; exit}'
}

# private_apt FOLDER [SUITE] [ARCHITECTURE]: an apt of its own in FOLDER, which knows that suite (godot_suite unless given)
# and nothing else. Prints its configuration file. FOLDER is a plain name: apt's settings cannot hold every name a folder
# may have.
private_apt() {
    local work=$1 suite=${2:-$godot_suite} architecture=${3:-$(dpkg --print-architecture)}
    local keyring=/usr/share/keyrings/debian-archive-keyring.gpg mirror
    need "$keyring:debian-archive-keyring" >&2
    mirror=$(debian_mirror)
    [[ -n $mirror ]] || die "no Debian mirror among this machine's apt sources; install Godot" \
        "$minimum_godot or later yourself, on PATH or as GODOT, and give a checkout of Jolt by jolt=PATH"
    mkdir -p "$work"/{lists,archives}/partial "$work/empty"
    : >"$work/status"
    printf '%s [signed-by=%s] %s %s main\n' deb "$keyring" "$mirror" "$suite" \
        deb-src "$keyring" "$mirror" "$suite" >"$work/sources.list"
    {
        # Proxies and the like are this machine's own; its hooks are not run.
        apt-config dump | grep -E '^Acquire::(http|https|ftp|Check|Retries)' || true
        cat <<CONF
Dir::State "$work";
Dir::State::lists "$work/lists";
Dir::State::status "$work/status";
Dir::Cache "$work";
Dir::Cache::archives "$work/archives";
Dir::Etc::sourcelist "$work/sources.list";
Dir::Etc::sourceparts "$work/empty";
Dir::Etc::preferencesparts "$work/empty";
Dir::Etc::parts "$work/empty";
Acquire::Languages "none";
Acquire::IndexTargets::deb::DEP-11::DefaultEnabled "false";
Acquire::Retries "3";
APT::Architecture "$architecture";
APT::Architectures { "$architecture"; };
APT::Install-Recommends "false";
APT::Sandbox::User "";
Debug::NoLocking "true";
CONF
    } >"$work/apt.conf"
    APT_CONFIG=$work/apt.conf apt-get -qq update
    echo "$work/apt.conf"
}

fetch_copy() { # fetch_copy FOLDER: unpacks into FOLDER/copy; an interrupted download resumes
    local work configuration package
    link_folder=$(mktemp -d)
    trap 'rm -rf "$link_folder"' EXIT
    mkdir -p "$1"
    ln -s "$1" "$link_folder/work"
    work=$link_folder/work
    configuration=$(private_apt "$work")
    APT_CONFIG=$configuration apt-get -qq -y --download-only install \
        godot libgl1 libegl1 libgl1-mesa-dri patchelf
    rm -rf "$work/copy"
    mkdir -p "$work/copy/root"
    for package in "$work"/archives/*.deb; do
        dpkg-deb --extract "$package" "$work/copy/root"
    done
    rm -rf "$work"/copy/root/usr/share/{doc,man,locale}
    ln -s root/usr/bin/godot "$work/copy/godot"
    echo "$copy_version" >"$work/copy/made"
}

# Sets loader, libraries and patcher: the copy's own C library, the folder of its libraries, and the command that patches.
look_into_copy() {
    loader=$(find "$copy/root/usr/lib" -name 'ld-linux*.so.*' -type f | head -n 1)
    libraries=$(dirname "$(find "$copy/root/usr/lib" -name libc.so.6 | head -n 1)")
    patcher=("$loader" --library-path "$libraries" "$copy/root/usr/bin/patchelf")
}

# use_copy PROGRAM FOLDER: it takes its C library from the copy and its libraries from FOLDER. RPATH, not RUNPATH: it holds
# for libraries of libraries, and for those that are loaded later by name, as the drivers of OpenGL are.
use_copy() { "${patcher[@]}" --set-interpreter "$loader" --force-rpath --set-rpath "$2:$2/pulseaudio" "$1"; }

# Patches the copy for the place where it is.
settle_copy() {
    local tree=$copy/root loader libraries patcher library
    look_into_copy
    # A library with a path of its own does not search the program's: nor would what it loads be found.
    for library in "$libraries"/*.so* "$libraries"/pulseaudio/*.so*; do
        [[ -f $library && ! -L $library && -n $("${patcher[@]}" --print-rpath "$library" 2>/dev/null) ]] || continue
        "${patcher[@]}" --remove-rpath "$library"
    done
    # A new file, then renamed: a Godot that runs keeps its own.
    cp "$tree/usr/bin/godot" "$tree/usr/bin/godot.new"
    use_copy "$tree/usr/bin/godot.new" "\$ORIGIN/../lib/${libraries##*/}"
    mv "$tree/usr/bin/godot.new" "$tree/usr/bin/godot"
    new_enough "$copy/godot" || die "the Godot of $godot_suite does not run here; install" \
        "Godot $minimum_godot or later yourself, on PATH or as GODOT"
    echo "$copy_version $copy" >"$copy/made"
}

# --- Export templates --------------------------------------------------------------------------------

# Sets templates: a folder with the programs godot-template-debug and godot-template-release, Debian's own, of exactly the
# version of the Godot in use. Those for the private Godot use its libraries, as what is exported by them does.
find_templates() {
    local version
    version=$("$GODOT" --headless --version | tail -n 1)
    [[ $version == *.debian* ]] || die "GODOT is version $version, not one of Debian's: a real export needs" \
        "templates of the same version, and only Debian's are fetched"
    templates=$cache/templates/$version
    mkdir -p "$cache/templates"
    fetch_once "$templates" "export templates" fetch_templates "${version##*.debian}"
}

fetch_templates() { # fetch_templates DEBIAN_VERSION
    local work configuration kind loader libraries patcher
    work=$(mktemp -d)
    # shellcheck disable=SC2064 # this folder, not one of a later call
    trap "rm -rf '$work'" EXIT
    configuration=$(private_apt "$work")
    (cd "$work/archives" && APT_CONFIG=$configuration apt-get -qq download \
        "godot-template-debug=$1" "godot-template-release=$1") ||
        die "$godot_suite has no export templates of version $1 any more: remove $copy, and the next" \
            "./dev build fetches the newer Godot"
    mkdir -p "$work/programs"
    for kind in debug release; do
        dpkg-deb --extract "$work/archives/godot-template-$kind"_*.deb "$work/$kind"
        mv "$work/$kind/usr/bin/godot-template-$kind" "$work/programs/"
        if [[ $GODOT == "$copy/"* ]]; then
            look_into_copy
            use_copy "$work/programs/godot-template-$kind" "$libraries"
        fi
    done
    mv "$work/programs" "$templates"
}
