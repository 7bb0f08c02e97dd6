from ocs_design.robot.packages import is_below, package_roots, roots_of


def test_the_folder_and_the_package_around_it(tmp_path):
    folder = tmp_path / "package" / "urdf"
    folder.mkdir(parents=True)
    assert roots_of(folder / "robot.urdf") == (folder,)
    (tmp_path / "package" / "package.xml").touch()
    assert set(roots_of(folder / "robot.urdf")) == {folder, tmp_path / "package"}
    assert is_below(folder / "../meshes/a.stl", roots_of(folder / "robot.urdf"))
    assert not is_below(folder / "../../a.stl", roots_of(folder / "robot.urdf"))


def test_a_workspace_that_is_installed_by_links(tmp_path):
    source, installed = tmp_path / "src", tmp_path / "install"
    source.mkdir()
    installed.mkdir()
    for name in ("package.xml", "robot.xacro", "leg.xacro"):
        (source / name).touch()
        (installed / name).symlink_to(source / name)
    assert is_below(installed / "leg.xacro", roots_of(installed / "robot.xacro"))
    assert package_roots(installed) == (installed, source)
    assert package_roots(tmp_path) == ()


def test_a_link_leads_out(tmp_path):
    (tmp_path / "robot").mkdir()
    (tmp_path / "secret").touch()
    (tmp_path / "robot" / "a").symlink_to(tmp_path / "secret")
    assert not is_below(tmp_path / "robot" / "a", roots_of(tmp_path / "robot" / "robot.xml"))
