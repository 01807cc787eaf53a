<?xml version="1.0" encoding="UTF-8"?>
<CityModel xmlns="http://www.opengis.net/citygml/2.0" xmlns:bldg="http://www.opengis.net/citygml/building/2.0" xmlns:gen="http://www.opengis.net/citygml/generics/2.0" xmlns:gml="http://www.opengis.net/gml" xmlns:xAL="urn:oasis:names:tc:ciq:xsdschema:xAL:2.0" xmlns:xlink="http://www.w3.org/1999/xlink" gml:id="cm.model">
<gml:description>citymesh VERSION export-for-simulation; crs EPSG:25833; unit metre; axes x east, y north, z up, right-handed; origin 391000 5820000 0</gml:description>
<gml:boundedBy>
<gml:Envelope srsName="urn:ogc:def:crs:EPSG::25833" srsDimension="3">
<gml:lowerCorner>391000.0000 5819995.0000 0.0000                             </gml:lowerCorner>
<gml:upperCorner>391042.0000 5820006.0000 4.0000                             </gml:upperCorner>
</gml:Envelope>
</gml:boundedBy>
<cityObjectMember>
<bldg:Building gml:id="b_1_house_one">
<gml:metaDataProperty><gml:GenericMetaData>citymesh rung healed</gml:GenericMetaData></gml:metaDataProperty>
<gml:name>Rathaus ä</gml:name>
<creationDate>2020-02-03</creationDate>
<gen:stringAttribute name="owner">
<gen:value>A &amp; B &lt;&quot;C&quot;&gt;</gen:value>
</gen:stringAttribute>
<gen:stringAttribute name="storeysBelowGround">
<gen:value>some</gen:value>
</gen:stringAttribute>
<gen:stringAttribute name="dateOfConstruction">
<gen:value>1987-05-06</gen:value>
</gen:stringAttribute>
<gen:stringAttribute name="listed">
<gen:value>true</gen:value>
</gen:stringAttribute>
<gen:intAttribute name="rooms">
<gen:value>-5</gen:value>
</gen:intAttribute>
<gen:doubleAttribute name="rent">
<gen:value>12.5</gen:value>
</gen:doubleAttribute>
<bldg:class>1000</bldg:class>
<bldg:function>1010</bldg:function>
<bldg:function>1020</bldg:function>
<bldg:usage>1010</bldg:usage>
<bldg:yearOfConstruction>1987</bldg:yearOfConstruction>
<bldg:roofType>1000</bldg:roofType>
<bldg:measuredHeight uom="m">3.25</bldg:measuredHeight>
<bldg:storeysAboveGround>1</bldg:storeysAboveGround>
<bldg:outerBuildingInstallation>
<bldg:BuildingInstallation gml:id="balcony">
<gen:doubleAttribute name="measuredHeight">
<gen:value>1.5</gen:value>
</gen:doubleAttribute>
<bldg:function>1000</bldg:function>
<bldg:lod2Geometry>
<gml:Solid gml:id="cm.balcony.s0">
<gml:exterior>
<gml:CompositeSurface gml:id="cm.balcony.k0">
<gml:surfaceMember xlink:href="#cm.balcony.p0"/>
<gml:surfaceMember xlink:href="#cm.balcony.p1"/>
<gml:surfaceMember xlink:href="#cm.balcony.p2"/>
<gml:surfaceMember xlink:href="#cm.balcony.p3"/>
<gml:surfaceMember xlink:href="#cm.balcony.p4"/>
<gml:surfaceMember xlink:href="#cm.balcony.p5"/>
</gml:CompositeSurface>
</gml:exterior>
</gml:Solid>
</bldg:lod2Geometry>
<bldg:boundedBy>
<bldg:GroundSurface gml:id="ground_3">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.balcony.m0">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.balcony.p0">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391002.0000 5819996.0000 1.0000 391004.0000 5819996.0000 1.0000 391004.0000 5819995.0000 1.0000 391002.0000 5819995.0000 1.0000 391002.0000 5819996.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:GroundSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_0_2">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.balcony.m1">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.balcony.p1">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391002.0000 5819995.0000 1.0000 391004.0000 5819995.0000 1.0000 391004.0000 5819995.0000 2.0000 391002.0000 5819995.0000 2.0000 391002.0000 5819995.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_1_2">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.balcony.m2">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.balcony.p2">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391004.0000 5819995.0000 1.0000 391004.0000 5819996.0000 1.0000 391004.0000 5819996.0000 2.0000 391004.0000 5819995.0000 2.0000 391004.0000 5819995.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_2_3">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.balcony.m3">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.balcony.p3">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391004.0000 5819996.0000 1.0000 391002.0000 5819996.0000 1.0000 391002.0000 5819996.0000 2.0000 391004.0000 5819996.0000 2.0000 391004.0000 5819996.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_3_3">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.balcony.m4">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.balcony.p4">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391002.0000 5819996.0000 1.0000 391002.0000 5819995.0000 1.0000 391002.0000 5819995.0000 2.0000 391002.0000 5819996.0000 2.0000 391002.0000 5819996.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:RoofSurface gml:id="roof_3">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.balcony.m5">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.balcony.p5">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391002.0000 5819995.0000 2.0000 391004.0000 5819995.0000 2.0000 391004.0000 5819996.0000 2.0000 391002.0000 5819996.0000 2.0000 391002.0000 5819995.0000 2.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:RoofSurface>
</bldg:boundedBy>
</bldg:BuildingInstallation>
</bldg:outerBuildingInstallation>
<bldg:boundedBy>
<bldg:GroundSurface gml:id="GML_ground">
<bldg:lod3MultiSurface>
<gml:MultiSurface gml:id="cm.b_1_house_one.m0">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.b_1_house_one.p0">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820000.0000 0.0000 391000.0000 5820006.0000 0.0000 391008.0000 5820006.0000 0.0000 391008.0000 5820000.0000 0.0000 391000.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod3MultiSurface>
</bldg:GroundSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="GML_south">
<bldg:lod3MultiSurface>
<gml:MultiSurface gml:id="cm.b_1_house_one.m1">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.b_1_house_one.p1">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820000.0000 0.0000 391008.0000 5820000.0000 0.0000 391008.0000 5820000.0000 3.0000 391000.0000 5820000.0000 3.0000 391000.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
<gml:interior><gml:LinearRing><gml:posList srsDimension="3">391002.0000 5820000.0000 1.0000 391002.0000 5820000.0000 2.0000 391004.0000 5820000.0000 2.0000 391004.0000 5820000.0000 1.0000 391002.0000 5820000.0000 1.0000</gml:posList></gml:LinearRing></gml:interior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod3MultiSurface>
<bldg:opening>
<bldg:Window gml:id="GML_window">
<bldg:lod3MultiSurface>
<gml:MultiSurface gml:id="cm.b_1_house_one.m2">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.b_1_house_one.p2">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391002.0000 5820000.0000 1.0000 391004.0000 5820000.0000 1.0000 391004.0000 5820000.0000 2.0000 391002.0000 5820000.0000 2.0000 391002.0000 5820000.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod3MultiSurface>
</bldg:Window>
</bldg:opening>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="GML_east">
<bldg:lod3MultiSurface>
<gml:MultiSurface gml:id="cm.b_1_house_one.m3">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.b_1_house_one.p3">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391008.0000 5820000.0000 0.0000 391008.0000 5820006.0000 0.0000 391008.0000 5820006.0000 3.0000 391008.0000 5820000.0000 3.0000 391008.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod3MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="cm.b_1_house_one.b4">
<gen:stringAttribute name="citymesh_rung">
<gen:value>healed</gen:value>
</gen:stringAttribute>
<bldg:lod3MultiSurface>
<gml:MultiSurface gml:id="cm.b_1_house_one.m4">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.b_1_house_one.p4">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391008.0000 5820006.0000 0.0000 391000.0000 5820006.0000 0.0000 391000.0000 5820006.0000 3.0000 391008.0000 5820006.0000 3.0000 391008.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod3MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="cm.b_1_house_one.b5">
<bldg:lod3MultiSurface>
<gml:MultiSurface gml:id="cm.b_1_house_one.m5">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.b_1_house_one.p5">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820006.0000 0.0000 391000.0000 5820000.0000 0.0000 391000.0000 5820000.0000 3.0000 391000.0000 5820006.0000 3.0000 391000.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod3MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:RoofSurface gml:id="_roof_1_">
<bldg:lod3MultiSurface>
<gml:MultiSurface gml:id="cm.b_1_house_one.m6">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.b_1_house_one.p6">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820000.0000 3.0000 391008.0000 5820000.0000 3.0000 391008.0000 5820006.0000 3.0000 391000.0000 5820006.0000 3.0000 391000.0000 5820000.0000 3.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod3MultiSurface>
</bldg:RoofSurface>
</bldg:boundedBy>
<bldg:lod3Solid>
<gml:Solid gml:id="cm.b_1_house_one.s0">
<gml:exterior>
<gml:CompositeSurface gml:id="cm.b_1_house_one.k0">
<gml:surfaceMember xlink:href="#cm.b_1_house_one.p0"/>
<gml:surfaceMember xlink:href="#cm.b_1_house_one.p1"/>
<gml:surfaceMember xlink:href="#cm.b_1_house_one.p2"/>
<gml:surfaceMember xlink:href="#cm.b_1_house_one.p3"/>
<gml:surfaceMember xlink:href="#cm.b_1_house_one.p4"/>
<gml:surfaceMember xlink:href="#cm.b_1_house_one.p5"/>
<gml:surfaceMember xlink:href="#cm.b_1_house_one.p6"/>
</gml:CompositeSurface>
</gml:exterior>
</gml:Solid>
</bldg:lod3Solid>
<bldg:consistsOfBuildingPart>
<bldg:BuildingPart gml:id="part">
<bldg:roofType>flat roof</bldg:roofType>
<bldg:lod2Solid>
<gml:Solid gml:id="cm.part.s0">
<gml:exterior>
<gml:CompositeSurface gml:id="cm.part.k0">
<gml:surfaceMember xlink:href="#cm.part.p0"/>
<gml:surfaceMember xlink:href="#cm.part.p1"/>
<gml:surfaceMember xlink:href="#cm.part.p2"/>
<gml:surfaceMember xlink:href="#cm.part.p3"/>
<gml:surfaceMember xlink:href="#cm.part.p4"/>
<gml:surfaceMember xlink:href="#cm.part.p5"/>
<gml:surfaceMember xlink:href="#cm.part.p6"/>
<gml:surfaceMember xlink:href="#cm.part.p7"/>
<gml:surfaceMember xlink:href="#cm.part.p8"/>
<gml:surfaceMember xlink:href="#cm.part.p9"/>
</gml:CompositeSurface>
</gml:exterior>
<gml:interior>
<gml:CompositeSurface gml:id="cm.part.k1">
<gml:surfaceMember xlink:href="#cm.part.p10"/>
<gml:surfaceMember xlink:href="#cm.part.p11"/>
<gml:surfaceMember xlink:href="#cm.part.p12"/>
<gml:surfaceMember xlink:href="#cm.part.p13"/>
<gml:surfaceMember xlink:href="#cm.part.p14"/>
<gml:surfaceMember xlink:href="#cm.part.p15"/>
</gml:CompositeSurface>
</gml:interior>
<gml:interior>
<gml:CompositeSurface gml:id="cm.part.k2">
<gml:surfaceMember xlink:href="#cm.part.p16"/>
<gml:surfaceMember xlink:href="#cm.part.p17"/>
<gml:surfaceMember xlink:href="#cm.part.p18"/>
<gml:surfaceMember xlink:href="#cm.part.p19"/>
<gml:surfaceMember xlink:href="#cm.part.p20"/>
<gml:surfaceMember xlink:href="#cm.part.p21"/>
</gml:CompositeSurface>
</gml:interior>
</gml:Solid>
</bldg:lod2Solid>
<bldg:boundedBy>
<bldg:GroundSurface gml:id="ground">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m0">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p0">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391020.0000 5820006.0000 0.0000 391029.0000 5820006.0000 0.0000 391029.0000 5820000.0000 0.0000 391020.0000 5820000.0000 0.0000 391020.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
<gml:interior><gml:LinearRing><gml:posList srsDimension="3">391027.0000 5820002.0000 0.0000 391028.0000 5820002.0000 0.0000 391028.0000 5820004.0000 0.0000 391027.0000 5820004.0000 0.0000 391027.0000 5820002.0000 0.0000</gml:posList></gml:LinearRing></gml:interior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:GroundSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m1">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p1">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391020.0000 5820000.0000 0.0000 391029.0000 5820000.0000 0.0000 391029.0000 5820000.0000 4.0000 391020.0000 5820000.0000 4.0000 391020.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="shaft">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m2">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p2">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391028.0000 5820002.0000 0.0000 391027.0000 5820002.0000 0.0000 391027.0000 5820002.0000 4.0000 391028.0000 5820002.0000 4.0000 391028.0000 5820002.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_2">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m3">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p3">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391029.0000 5820000.0000 0.0000 391029.0000 5820006.0000 0.0000 391029.0000 5820006.0000 4.0000 391029.0000 5820000.0000 4.0000 391029.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="shaft_2">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m4">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p4">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391028.0000 5820004.0000 0.0000 391028.0000 5820002.0000 0.0000 391028.0000 5820002.0000 4.0000 391028.0000 5820004.0000 4.0000 391028.0000 5820004.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_3">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m5">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p5">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391029.0000 5820006.0000 0.0000 391020.0000 5820006.0000 0.0000 391020.0000 5820006.0000 4.0000 391029.0000 5820006.0000 4.0000 391029.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="shaft_3">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m6">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p6">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391027.0000 5820004.0000 0.0000 391028.0000 5820004.0000 0.0000 391028.0000 5820004.0000 4.0000 391027.0000 5820004.0000 4.0000 391027.0000 5820004.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_4">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m7">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p7">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391020.0000 5820006.0000 0.0000 391020.0000 5820000.0000 0.0000 391020.0000 5820000.0000 4.0000 391020.0000 5820006.0000 4.0000 391020.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="shaft_4">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m8">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p8">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391027.0000 5820002.0000 0.0000 391027.0000 5820004.0000 0.0000 391027.0000 5820004.0000 4.0000 391027.0000 5820002.0000 4.0000 391027.0000 5820002.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:RoofSurface gml:id="roof">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m9">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p9">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391020.0000 5820000.0000 4.0000 391029.0000 5820000.0000 4.0000 391029.0000 5820006.0000 4.0000 391020.0000 5820006.0000 4.0000 391020.0000 5820000.0000 4.0000</gml:posList></gml:LinearRing></gml:exterior>
<gml:interior><gml:LinearRing><gml:posList srsDimension="3">391027.0000 5820004.0000 4.0000 391028.0000 5820004.0000 4.0000 391028.0000 5820002.0000 4.0000 391027.0000 5820002.0000 4.0000 391027.0000 5820004.0000 4.0000</gml:posList></gml:LinearRing></gml:interior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:RoofSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:InteriorWallSurface gml:id="hollow">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m10">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p10">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391021.0000 5820001.0000 1.0000 391023.0000 5820001.0000 1.0000 391023.0000 5820003.0000 1.0000 391021.0000 5820003.0000 1.0000 391021.0000 5820001.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:InteriorWallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:InteriorWallSurface gml:id="hollow_2">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m11">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p11">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391021.0000 5820003.0000 3.0000 391023.0000 5820003.0000 3.0000 391023.0000 5820001.0000 3.0000 391021.0000 5820001.0000 3.0000 391021.0000 5820003.0000 3.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:InteriorWallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:InteriorWallSurface gml:id="hollow_3">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m12">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p12">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391021.0000 5820001.0000 1.0000 391021.0000 5820001.0000 3.0000 391023.0000 5820001.0000 3.0000 391023.0000 5820001.0000 1.0000 391021.0000 5820001.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:InteriorWallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:InteriorWallSurface gml:id="hollow_4">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m13">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p13">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391023.0000 5820001.0000 1.0000 391023.0000 5820001.0000 3.0000 391023.0000 5820003.0000 3.0000 391023.0000 5820003.0000 1.0000 391023.0000 5820001.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:InteriorWallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:InteriorWallSurface gml:id="hollow_5">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m14">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p14">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391023.0000 5820003.0000 1.0000 391023.0000 5820003.0000 3.0000 391021.0000 5820003.0000 3.0000 391021.0000 5820003.0000 1.0000 391023.0000 5820003.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:InteriorWallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:InteriorWallSurface gml:id="hollow_6">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m15">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p15">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391021.0000 5820003.0000 1.0000 391021.0000 5820003.0000 3.0000 391021.0000 5820001.0000 3.0000 391021.0000 5820001.0000 1.0000 391021.0000 5820003.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:InteriorWallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:InteriorWallSurface gml:id="hollow_7">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m16">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p16">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391024.0000 5820001.0000 1.0000 391026.0000 5820001.0000 1.0000 391026.0000 5820003.0000 1.0000 391024.0000 5820003.0000 1.0000 391024.0000 5820001.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:InteriorWallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:InteriorWallSurface gml:id="hollow_8">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m17">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p17">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391024.0000 5820003.0000 3.0000 391026.0000 5820003.0000 3.0000 391026.0000 5820001.0000 3.0000 391024.0000 5820001.0000 3.0000 391024.0000 5820003.0000 3.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:InteriorWallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:InteriorWallSurface gml:id="hollow_9">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m18">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p18">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391024.0000 5820001.0000 1.0000 391024.0000 5820001.0000 3.0000 391026.0000 5820001.0000 3.0000 391026.0000 5820001.0000 1.0000 391024.0000 5820001.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:InteriorWallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:InteriorWallSurface gml:id="hollow_10">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m19">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p19">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391026.0000 5820001.0000 1.0000 391026.0000 5820001.0000 3.0000 391026.0000 5820003.0000 3.0000 391026.0000 5820003.0000 1.0000 391026.0000 5820001.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:InteriorWallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:InteriorWallSurface gml:id="hollow_11">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m20">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p20">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391026.0000 5820003.0000 1.0000 391026.0000 5820003.0000 3.0000 391024.0000 5820003.0000 3.0000 391024.0000 5820003.0000 1.0000 391026.0000 5820003.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:InteriorWallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:InteriorWallSurface gml:id="hollow_12">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m21">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p21">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391024.0000 5820003.0000 1.0000 391024.0000 5820003.0000 3.0000 391024.0000 5820001.0000 3.0000 391024.0000 5820001.0000 1.0000 391024.0000 5820003.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:InteriorWallSurface>
</bldg:boundedBy>
<bldg:address>
<Address gml:id="cm.part.a0">
<xalAddress>
<xAL:AddressDetails>
<xAL:Country>
<xAL:Locality Type="City">
<xAL:LocalityName>Potsdam</xAL:LocalityName>
</xAL:Locality>
</xAL:Country>
</xAL:AddressDetails>
</xalAddress>
</Address>
</bldg:address>
</bldg:BuildingPart>
</bldg:consistsOfBuildingPart>
<bldg:consistsOfBuildingPart>
<bldg:BuildingPart gml:id="low">
<bldg:lod1Solid>
<gml:Solid gml:id="cm.low.s0">
<gml:exterior>
<gml:CompositeSurface gml:id="cm.low.k0">
<gml:surfaceMember>
<gml:Polygon gml:id="ground_2">
<gml:name>GroundSurface</gml:name>
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391040.0000 5820002.0000 0.0000 391042.0000 5820002.0000 0.0000 391042.0000 5820000.0000 0.0000 391040.0000 5820000.0000 0.0000 391040.0000 5820002.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
<gml:surfaceMember>
<gml:Polygon gml:id="wall_0">
<gml:name>WallSurface</gml:name>
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391040.0000 5820000.0000 0.0000 391042.0000 5820000.0000 0.0000 391042.0000 5820000.0000 2.0000 391040.0000 5820000.0000 2.0000 391040.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
<gml:surfaceMember>
<gml:Polygon gml:id="wall_1">
<gml:name>WallSurface</gml:name>
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391042.0000 5820000.0000 0.0000 391042.0000 5820002.0000 0.0000 391042.0000 5820002.0000 2.0000 391042.0000 5820000.0000 2.0000 391042.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
<gml:surfaceMember>
<gml:Polygon gml:id="wall_2_2">
<gml:name>WallSurface</gml:name>
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391042.0000 5820002.0000 0.0000 391040.0000 5820002.0000 0.0000 391040.0000 5820002.0000 2.0000 391042.0000 5820002.0000 2.0000 391042.0000 5820002.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
<gml:surfaceMember>
<gml:Polygon gml:id="wall_3_2">
<gml:name>WallSurface</gml:name>
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391040.0000 5820002.0000 0.0000 391040.0000 5820000.0000 0.0000 391040.0000 5820000.0000 2.0000 391040.0000 5820002.0000 2.0000 391040.0000 5820002.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
<gml:surfaceMember>
<gml:Polygon gml:id="roof_2">
<gml:name>RoofSurface</gml:name>
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391040.0000 5820000.0000 2.0000 391042.0000 5820000.0000 2.0000 391042.0000 5820002.0000 2.0000 391040.0000 5820002.0000 2.0000 391040.0000 5820000.0000 2.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:CompositeSurface>
</gml:exterior>
</gml:Solid>
</bldg:lod1Solid>
</bldg:BuildingPart>
</bldg:consistsOfBuildingPart>
<bldg:address>
<Address gml:id="cm.b_1_house_one.a0">
<xalAddress>
<xAL:AddressDetails>
<xAL:Country>
<xAL:CountryName>Germany</xAL:CountryName>
<xAL:AdministrativeArea>
<xAL:AdministrativeAreaName>BE</xAL:AdministrativeAreaName>
<xAL:Locality Type="City">
<xAL:LocalityName>Berlin</xAL:LocalityName>
<xAL:PostBox><xAL:PostBoxNumber>PO 7</xAL:PostBoxNumber></xAL:PostBox>
<xAL:Thoroughfare Type="Street">
<xAL:ThoroughfareNumber>12a</xAL:ThoroughfareNumber>
<xAL:ThoroughfareName>Main Street</xAL:ThoroughfareName>
</xAL:Thoroughfare>
<xAL:PostalCode><xAL:PostalCodeNumber>12345</xAL:PostalCodeNumber></xAL:PostalCode>
</xAL:Locality>
</xAL:AdministrativeArea>
</xAL:Country>
</xAL:AddressDetails>
</xalAddress>
</Address>
</bldg:address>
<bldg:address>
<Address gml:id="cm.b_1_house_one.a1">
<xalAddress>
<xAL:AddressDetails>
<xAL:Country>
<xAL:Locality Type="City">
<xAL:LocalityName>Berlin</xAL:LocalityName>
<xAL:Thoroughfare Type="Street">
<xAL:ThoroughfareName>Side Street</xAL:ThoroughfareName>
</xAL:Thoroughfare>
</xAL:Locality>
</xAL:Country>
</xAL:AddressDetails>
</xalAddress>
</Address>
</bldg:address>
</bldg:Building>
</cityObjectMember>
<cityObjectMember>
<bldg:Building gml:id="cube">
<gml:metaDataProperty><gml:GenericMetaData>citymesh rung as_is</gml:GenericMetaData></gml:metaDataProperty>
<bldg:function>31001_1000</bldg:function>
<bldg:measuredHeight uom="m">1</bldg:measuredHeight>
<bldg:lod2Solid>
<gml:Solid gml:id="cm.cube.s0">
<gml:exterior>
<gml:CompositeSurface gml:id="cm.cube.k0">
<gml:surfaceMember xlink:href="#cm.cube.p0"/>
<gml:surfaceMember xlink:href="#cm.cube.p1"/>
<gml:surfaceMember xlink:href="#cm.cube.p2"/>
<gml:surfaceMember xlink:href="#cm.cube.p3"/>
<gml:surfaceMember xlink:href="#cm.cube.p4"/>
<gml:surfaceMember xlink:href="#cm.cube.p5"/>
</gml:CompositeSurface>
</gml:exterior>
</gml:Solid>
</bldg:lod2Solid>
<bldg:boundedBy>
<bldg:GroundSurface gml:id="ground_4">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m0">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p0">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820001.0000 0.0000 391001.0000 5820001.0000 0.0000 391001.0000 5820000.0000 0.0000 391000.0000 5820000.0000 0.0000 391000.0000 5820001.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:GroundSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_0_3">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m1">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p1">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820000.0000 0.0000 391001.0000 5820000.0000 0.0000 391001.0000 5820000.0000 1.0000 391000.0000 5820000.0000 1.0000 391000.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_1_3">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m2">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p2">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391001.0000 5820000.0000 0.0000 391001.0000 5820001.0000 0.0000 391001.0000 5820001.0000 1.0000 391001.0000 5820000.0000 1.0000 391001.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_2_4">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m3">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p3">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391001.0000 5820001.0000 0.0000 391000.0000 5820001.0000 0.0000 391000.0000 5820001.0000 1.0000 391001.0000 5820001.0000 1.0000 391001.0000 5820001.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_3_4">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m4">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p4">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820001.0000 0.0000 391000.0000 5820000.0000 0.0000 391000.0000 5820000.0000 1.0000 391000.0000 5820001.0000 1.0000 391000.0000 5820001.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:RoofSurface gml:id="roof_4">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m5">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p5">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820000.0000 1.0000 391001.0000 5820000.0000 1.0000 391001.0000 5820001.0000 1.0000 391000.0000 5820001.0000 1.0000 391000.0000 5820000.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:RoofSurface>
</bldg:boundedBy>
</bldg:Building>
</cityObjectMember>
</CityModel>
