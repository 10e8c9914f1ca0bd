# ./dev release: everything of a release that a machine can do.

release() { # release VERSION [--skip-tests] [--zip FILE]: FILE in place of a new zip, for example one of ./dev test-release
    local version="" skip_tests="" zip=""
    while (($#)); do
        case $1 in
        --skip-tests) skip_tests=--skip-tests && shift ;;
        --zip) zip=$(absolute "${2:?dev: --zip needs a file}") && shift 2 ;;
        -*) die "release has no option $1" ;;
        *) [[ -z $version ]] || die "release takes one version: $version, $1"
            version=$1 && shift ;;
        esac
    done
    if [[ -z $version ]]; then
        [[ -t 0 ]] || die "release needs a version: ./dev release 1.2.3"
        read -rp "Version to release (version.py says $(release_version)): " version
    fi
    need python3:python3 git:git
    python3 tools/dev/release.py check "$version" $skip_tests
    [[ -n $skip_tests ]] || ./dev test
    if [[ -z $zip ]]; then
        package_and_try
        zip=dist/spidar_g-$version.zip
    fi
    python3 tools/dev/release.py finish "$version" "$zip" $skip_tests
}

release_version() { sed -nE 's/^version = "(.*)"/\1/p' version.py; }
