"""tools/docs/check_help.py and class_help.py: help that says too little is listed, other help is not."""

import os
import tempfile
import unittest

import repository  # noqa: F401 (the path)
import check_help
import class_help

XML = """<class name="Thing" inherits="Node">
	<brief_description>
		Carries a body through the scene and lets it go.
	</brief_description>
	<description>
	</description>
	<methods>
		<method name="_ready"><return type="void" /><description></description></method>
		<method name="open" qualifiers="const">
			<return type="int" enum="Thing.State" />
			<param index="0" name="path" type="String" default="&quot;&quot;" />
			<description>
				{}
			</description>
		</method>
	</methods>
	<constants>
		<constant name="Loaded" value="&lt;Object&gt;"></constant>
	</constants>
</class>
"""


def faults(text):
    with tempfile.TemporaryDirectory() as folder:
        for name in ("Thing.xml", "addons--inner.gd.xml"):
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(XML.format(text))
        return check_help.faults(class_help.read_folder(folder), check_help.read_verbs())


class Help(unittest.TestCase):
    def expect(self, text, fault):
        rows = faults(text)
        self.assertEqual([row[1] for row in rows], ["Thing", "Thing.open (method)"])
        self.assertEqual([row[2] for row in rows], [None, fault], text)

    def test_good_text(self):
        self.expect("Opens the recording [param path] and returns its state.", None)
        self.expect("If [code]true[/code], the pads are drawn on the surface.", None)

    def test_a_verb_that_is_also_a_noun(self):
        self.expect("The gate limits the force of each contact here.", None)
        self.expect("The force limits of each contact, one after the other.", "no verb")

    def test_empty(self):
        self.expect("", "empty")
        self.expect("[br][br]", "empty")

    def test_short(self):
        self.expect("Opens it.", "9 characters")
        self.expect("[b]Opens[/b] [i]it[/i].[codeblock]\nthing.open(\"a long path of a recording\")\n[/codeblock]", "10 characters")

    def test_no_verb(self):
        self.expect("The 8 commanded tensions in newtons, after every limit.", "no verb")
        self.expect("The state, [code]is_open returns opens[/code], of a device at home.", "no verb")

    def test_what_a_class_holds(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "Thing.xml"), "w", encoding="utf-8") as file:
                file.write(XML.format("A [b]text[/b]."))
            (each,) = class_help.read_folder(folder)
        self.assertEqual([item.name for item in each.items], ["open"])
        self.assertEqual(each.items[0], class_help.Item(
            "method", "open", "Thing.State", [("path", "String", '""')], "", "const", "A [b]text[/b]."))
