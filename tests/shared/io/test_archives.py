"""Archives that nobody vouches for: good members come out, bad ones are named, bombs are refused."""

import gzip
import io
import pickle
import stat
import struct
import tarfile
import zipfile
from pathlib import Path

import numpy as np
import pytest

from partwise.errors import FileFormatError, ParameterError
from partwise.io.archive_limits import ArchiveError, ArchiveLimits
from partwise.io.archives import MAX_NAME, ArchivedFile, RefusedMember, plain_name, read_archive
from partwise.io.limits import MIB, ReadLimits

MESH = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
FORMATS = ("zip", "tar.gz")
WRONG_NAMES = [
    "../a.off",
    "x/../../a.off",
    "/etc/a.off",
    "C:/a.off",
    "x\\..\\a.off",
    "\\\\host\\a.off",
    f"{'x' * MAX_NAME}.off",
]


def is_mesh(name: str) -> bool:
    return name.endswith(".off")


def archive(folder: Path, form: str, files: list[tuple[str, bytes]]) -> Path:
    path = folder / f"made.{form}"
    if form == "zip":
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as made:
            for name, data in files:
                info = zipfile.ZipInfo(name)
                info.compress_type = zipfile.ZIP_DEFLATED
                made.writestr(info, data)
        return path
    with tarfile.open(path, "w:gz") as made:
        for name, data in files:
            info = tarfile.TarInfo(name)
            info.size = len(data)
            made.addfile(info, io.BytesIO(data))
    return path


def read(path: Path, limits: ArchiveLimits | None = None) -> tuple[dict[str, bytes], list[str]]:
    """Files by name, and reasons of refused members."""
    found = list(read_archive(path, is_mesh, limits))
    files = {each.name: each.data for each in found if isinstance(each, ArchivedFile)}
    return files, [each.reason for each in found if isinstance(each, RefusedMember)]


@pytest.mark.parametrize("form", FORMATS)
class TestBoth:
    def test_files_come_out_as_they_went_in(self, tmp_path, form) -> None:
        files = [("a.off", MESH), ("./sub/b.off", MESH * 2), ("large.off", bytes(range(256)) * 8192)]
        assert read(archive(tmp_path, form, files)) == ({"a.off": MESH, "sub/b.off": MESH * 2, **dict(files[2:])}, [])

    def test_what_is_not_wanted_is_passed_over(self, tmp_path, form) -> None:
        files = [("notes.txt", b"x"), (".hidden.off", MESH), ("__MACOSX/._a.off", b"x"), ("a.off", MESH)]
        assert read(archive(tmp_path, form, files)) == ({"a.off": MESH}, [])

    @pytest.mark.parametrize("name", WRONG_NAMES)
    def test_a_name_that_leads_elsewhere_is_refused_and_the_rest_goes_on(self, tmp_path, form, name) -> None:
        files, refused = read(archive(tmp_path, form, [(name, MESH), ("good.off", MESH)]))
        assert files == {"good.off": MESH}
        assert len(refused) == 1
        assert refused[0].startswith(name[:MAX_NAME])

    def test_a_name_that_comes_again_is_refused(self, tmp_path, form) -> None:
        files, refused = read(archive(tmp_path, form, [("a.off", MESH), ("./a.off", b"other"), ("b.off", MESH)]))
        assert files == {"a.off": MESH, "b.off": MESH}
        assert "comes again" in refused[0]

    @pytest.mark.parametrize("nested", ["inner.zip", "inner.tar.gz", "inner.tgz", "inner.off.gz"])
    def test_archives_within_an_archive_are_named_and_not_opened(self, tmp_path, form, nested) -> None:
        files, refused = read(archive(tmp_path, form, [(nested, b"PK\x03\x04"), ("a.off", MESH)]))
        assert files == {"a.off": MESH}
        assert "not opened" in refused[0]

    def test_a_pickle_is_never_loaded(self, tmp_path, form) -> None:
        class Bomb:
            def __reduce__(self):
                return pytest.fail, ("unpickled",)

        data = pickle.dumps(Bomb())
        files, _ = read(archive(tmp_path, form, [("a.pkl", data), ("b.off", data)]))
        assert files == {"b.off": data}

    def test_a_file_that_is_too_large_is_refused(self, tmp_path, form) -> None:
        limits = ArchiveLimits(member=ReadLimits(max_bytes=100))
        files, refused = read(archive(tmp_path, form, [("a.off", b"x" * 101), ("b.off", MESH)]), limits)
        assert files == {"b.off": MESH}
        assert "100 bytes" in refused[0]

    def test_too_many_members_are_refused(self, tmp_path, form) -> None:
        files = [(f"{n}.off", MESH) for n in range(4)]
        with pytest.raises(FileFormatError, match="3 members"):
            read(archive(tmp_path, form, files), ArchiveLimits(max_members=3))

    def test_too_many_bytes_in_all_are_refused(self, tmp_path, form) -> None:
        files = [(f"{n}.off", b"x" * 100) for n in range(4)]
        with pytest.raises(ArchiveError, match="350 bytes"):
            read(archive(tmp_path, form, files), ArchiveLimits(max_total_bytes=350))

    @pytest.mark.parametrize("cut", [0.3, 0.9])
    def test_a_damaged_archive_is_refused(self, tmp_path, form, cut) -> None:
        path = archive(tmp_path, form, [("a.off", bytes(range(256)) * 64)])
        data = path.read_bytes()
        path.write_bytes(data[: int(len(data) * cut)])
        with pytest.raises(FileFormatError, match="archive"):
            read(path)

    def test_what_is_no_archive_is_refused(self, tmp_path, form) -> None:
        path = tmp_path / f"made.{form}"
        path.write_bytes(b"<script>alert(1)</script>" * 100)
        with pytest.raises(FileFormatError, match="archive"):
            read(path)


def test_an_archive_is_known_by_its_name(tmp_path) -> None:
    with pytest.raises(FileFormatError, match=r"\.zip"):
        read(tmp_path / "a.rar")


@pytest.mark.parametrize("name", ["", ".", "..", "/", "a/..", "a\nb", "a\x00b", "a\u202eb", "a\ud800b"])
def test_names_are_relative_paths_of_plain_steps(name) -> None:
    with pytest.raises(FileFormatError):
        plain_name(name)


@pytest.mark.parametrize("name", ["max_members", "max_total_bytes", "max_ratio"])
def test_limits_are_positive(name) -> None:
    with pytest.raises(ParameterError, match=name):
        ArchiveLimits(**{name: 0})


class TestZip:
    def test_a_member_that_expands_too_far_is_refused_and_the_rest_goes_on(self, tmp_path) -> None:
        path = archive(tmp_path, "zip", [("bomb.off", bytes(8 * MIB)), ("a.off", MESH)])
        files, refused = read(path)
        assert files == {"a.off": MESH}
        assert "200 times" in refused[0]

    def test_members_that_expand_too_far_share_one_mebibyte(self, tmp_path) -> None:
        path = archive(tmp_path, "zip", [(f"{n}.off", bytes(MIB)) for n in range(20)])
        files, refused = read(path)
        assert len(files) == 1
        assert len(refused) == 19
        assert sum(map(len, files.values())) <= MIB + 200 * path.stat().st_size

    def test_members_that_overlap_are_refused(self, tmp_path) -> None:
        """Many entries of the directory share one member's bytes: as in archives of 42 kB that expand to petabytes."""
        path = archive(tmp_path, "zip", [("a.off", MESH * 50), ("b.off", MESH)])
        data = bytearray(path.read_bytes())
        second = data.rindex(b"PK\x01\x02")
        data[second + 42 : second + 46] = struct.pack("<L", 0)  # where b.off is said to begin: within a.off
        path.write_bytes(data)
        with pytest.raises(ArchiveError, match="overlap"):
            read(path)

    def test_a_member_that_reaches_into_the_directory_is_refused(self, tmp_path) -> None:
        path = archive(tmp_path, "zip", [("a.off", MESH)])
        data = bytearray(path.read_bytes())
        entry = data.rindex(b"PK\x01\x02")
        data[entry + 20 : entry + 24] = struct.pack("<L", len(data))
        path.write_bytes(data)
        with pytest.raises(ArchiveError, match="overlap"):
            read(path)

    @pytest.mark.parametrize("kind", [stat.S_IFLNK, stat.S_IFCHR, stat.S_IFBLK, stat.S_IFIFO, stat.S_IFSOCK])
    def test_links_and_devices_are_refused(self, tmp_path, kind) -> None:
        path = tmp_path / "made.zip"
        with zipfile.ZipFile(path, "w") as made:
            info = zipfile.ZipInfo("a.off")
            info.external_attr = (kind | 0o644) << 16
            made.writestr(info, "/etc/passwd")
            made.writestr("b.off", MESH)
        files, refused = read(path)
        assert files == {"b.off": MESH}
        assert "link or a device" in refused[0]

    def test_an_encrypted_member_is_refused(self, tmp_path) -> None:
        path = archive(tmp_path, "zip", [("a.off", MESH)])
        data = bytearray(path.read_bytes())
        for signature, at in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
            data[data.index(signature) + at] |= 1
        path.write_bytes(data)
        assert "encrypted" in read(path)[1][0]

    def test_an_unusual_method_is_refused(self, tmp_path) -> None:
        path = tmp_path / "made.zip"
        with zipfile.ZipFile(path, "w", zipfile.ZIP_LZMA) as made:
            made.writestr("a.off", MESH)
        assert "stored or deflated" in read(path)[1][0]

    def test_a_member_with_a_wrong_checksum_is_refused(self, tmp_path) -> None:
        path = tmp_path / "made.zip"
        with zipfile.ZipFile(path, "w") as made:
            made.writestr("a.off", MESH)
            made.writestr("b.off", MESH)
        path.write_bytes(path.read_bytes().replace(MESH, MESH.replace(b"OFF", b"OOF"), 1))
        files, refused = read(path)
        assert list(files) == ["b.off"]
        assert "damaged" in refused[0]

    def test_a_directory_that_would_fill_the_memory_is_not_read(self, tmp_path) -> None:
        path = archive(tmp_path, "zip", [("a.off", MESH)])
        data = bytearray(path.read_bytes())
        end = data.rindex(b"PK\x05\x06")
        data[end + 12 : end + 16] = struct.pack("<L", 1 << 30)
        path.write_bytes(data)
        with pytest.raises(ArchiveError, match="members"):
            read(path)

    def test_an_archive_of_over_65535_members_can_be_read(self, tmp_path) -> None:
        """Its directory is found through the larger records at its end."""
        path = tmp_path / "made.zip"
        with zipfile.ZipFile(path, "w") as made:
            for n in range(65_536):
                made.writestr(zipfile.ZipInfo(f"{n}.txt"), b"")
            made.writestr("a.off", MESH)
        assert read(path) == ({"a.off": MESH}, [])
        with pytest.raises(ArchiveError, match="members"):
            read(path, ArchiveLimits(max_members=1_000))


class TestTar:
    @pytest.mark.parametrize(
        "kind", [tarfile.SYMTYPE, tarfile.LNKTYPE, tarfile.CHRTYPE, tarfile.BLKTYPE, tarfile.FIFOTYPE]
    )
    def test_links_and_devices_are_refused(self, tmp_path, kind) -> None:
        path = tmp_path / "made.tar.gz"
        with tarfile.open(path, "w:gz") as made:
            info = tarfile.TarInfo("a.off")
            info.type, info.linkname = kind, "/etc/passwd"
            made.addfile(info)
            good = tarfile.TarInfo("b.off")
            good.size = len(MESH)
            made.addfile(good, io.BytesIO(MESH))
        files, refused = read(path)
        assert files == {"b.off": MESH}
        assert "link, a device" in refused[0]

    def test_an_archive_that_expands_too_far_is_refused(self, tmp_path) -> None:
        path = archive(tmp_path, "tar.gz", [("a.off", MESH), ("bomb.off", bytes(8 * MIB))])
        with pytest.raises(ArchiveError, match="200 times"):
            read(path)

    def test_what_is_not_wanted_counts_as_well(self, tmp_path) -> None:
        path = archive(tmp_path, "tar.gz", [("bomb.txt", bytes(8 * MIB)), ("a.off", MESH)])
        with pytest.raises(ArchiveError, match="200 times"):
            read(path)

    def test_a_header_that_would_fill_the_memory_is_not_read(self, tmp_path) -> None:
        path = tmp_path / "made.tar.gz"
        header = tarfile.TarInfo("x")
        header.type, header.size = tarfile.XHDTYPE, 64 * MIB
        with gzip.open(path, "wb", compresslevel=1) as made:
            made.write(header.tobuf())
            for _ in range(4):  # of random bytes, which do not give it away by how far they expand
                made.write(np.random.default_rng(0).bytes(MIB))
        with pytest.raises(ArchiveError, match="header may have a mebibyte"):
            read(path)

    def test_a_file_with_holes_is_refused(self, tmp_path) -> None:
        path = tmp_path / "made.tar.gz"
        info = tarfile.TarInfo("a.off")
        info.type = tarfile.GNUTYPE_SPARSE
        with gzip.open(path, "wb") as made:
            made.write(info.tobuf(tarfile.GNU_FORMAT) + bytes(1024))
        assert "holes" in read(path)[1][0]

    def test_names_of_names_without_end_are_refused(self, tmp_path) -> None:
        path = tmp_path / "made.tar.gz"
        info = tarfile.TarInfo("././@LongLink")
        info.type, info.size = tarfile.GNUTYPE_LONGNAME, 6
        with gzip.open(path, "wb") as made:
            for _ in range(2_000):
                made.write(info.tobuf(tarfile.GNU_FORMAT) + b"a.off".ljust(512, b"\0"))
        with pytest.raises(ArchiveError, match="damaged"):
            read(path)

    def test_an_archive_with_a_wrong_checksum_is_refused(self, tmp_path) -> None:
        path = archive(tmp_path, "tar.gz", [("a.off", MESH)])
        data = bytearray(path.read_bytes())
        data[-8] ^= 1  # of the checksum at its end
        path.write_bytes(data)
        with pytest.raises(ArchiveError, match="damaged"):
            read(path)
