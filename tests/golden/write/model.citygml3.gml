<?xml version="1.0" encoding="UTF-8"?>
<CityModel xmlns="http://www.opengis.net/citygml/3.0" xmlns:bldg="http://www.opengis.net/citygml/building/3.0" xmlns:con="http://www.opengis.net/citygml/construction/3.0" xmlns:gen="http://www.opengis.net/citygml/generics/3.0" xmlns:gml="http://www.opengis.net/gml/3.2" xmlns:xAL="urn:oasis:names:tc:ciq:xal:3" xmlns:xlink="http://www.w3.org/1999/xlink" gml:id="cm.model">
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
<genericAttribute>
<gen:StringAttribute>
<gen:name>owner</gen:name>
<gen:value>A &amp; B &lt;&quot;C&quot;&gt;</gen:value>
</gen:StringAttribute>
</genericAttribute>
<genericAttribute>
<gen:StringAttribute>
<gen:name>storeysBelowGround</gen:name>
<gen:value>some</gen:value>
</gen:StringAttribute>
</genericAttribute>
<genericAttribute>
<gen:IntAttribute>
<gen:name>yearOfConstruction</gen:name>
<gen:value>1987</gen:value>
</gen:IntAttribute>
</genericAttribute>
<genericAttribute>
<gen:StringAttribute>
<gen:name>creationDate</gen:name>
<gen:value>2020-02-03</gen:value>
</gen:StringAttribute>
</genericAttribute>
<genericAttribute>
<gen:StringAttribute>
<gen:name>listed</gen:name>
<gen:value>true</gen:value>
</gen:StringAttribute>
</genericAttribute>
<genericAttribute>
<gen:IntAttribute>
<gen:name>rooms</gen:name>
<gen:value>-5</gen:value>
</gen:IntAttribute>
</genericAttribute>
<genericAttribute>
<gen:DoubleAttribute>
<gen:name>rent</gen:name>
<gen:value>12.5</gen:value>
</gen:DoubleAttribute>
</genericAttribute>
<boundary>
<con:GroundSurface gml:id="GML_ground">
<lod3MultiSurface>
<gml:MultiSurface gml:id="cm.b_1_house_one.m0">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.b_1_house_one.p0">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820000.0000 0.0000 391000.0000 5820006.0000 0.0000 391008.0000 5820006.0000 0.0000 391008.0000 5820000.0000 0.0000 391000.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod3MultiSurface>
</con:GroundSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="GML_south">
<lod3MultiSurface>
<gml:MultiSurface gml:id="cm.b_1_house_one.m1">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.b_1_house_one.p1">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820000.0000 0.0000 391008.0000 5820000.0000 0.0000 391008.0000 5820000.0000 3.0000 391000.0000 5820000.0000 3.0000 391000.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
<gml:interior><gml:LinearRing><gml:posList srsDimension="3">391002.0000 5820000.0000 1.0000 391002.0000 5820000.0000 2.0000 391004.0000 5820000.0000 2.0000 391004.0000 5820000.0000 1.0000 391002.0000 5820000.0000 1.0000</gml:posList></gml:LinearRing></gml:interior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod3MultiSurface>
<con:fillingSurface>
<con:WindowSurface gml:id="GML_window">
<lod3MultiSurface>
<gml:MultiSurface gml:id="cm.b_1_house_one.m2">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.b_1_house_one.p2">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391002.0000 5820000.0000 1.0000 391004.0000 5820000.0000 1.0000 391004.0000 5820000.0000 2.0000 391002.0000 5820000.0000 2.0000 391002.0000 5820000.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod3MultiSurface>
</con:WindowSurface>
</con:fillingSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="GML_east">
<lod3MultiSurface>
<gml:MultiSurface gml:id="cm.b_1_house_one.m3">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.b_1_house_one.p3">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391008.0000 5820000.0000 0.0000 391008.0000 5820006.0000 0.0000 391008.0000 5820006.0000 3.0000 391008.0000 5820000.0000 3.0000 391008.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod3MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="cm.b_1_house_one.b4">
<genericAttribute>
<gen:StringAttribute>
<gen:name>citymesh_rung</gen:name>
<gen:value>healed</gen:value>
</gen:StringAttribute>
</genericAttribute>
<lod3MultiSurface>
<gml:MultiSurface gml:id="cm.b_1_house_one.m4">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.b_1_house_one.p4">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391008.0000 5820006.0000 0.0000 391000.0000 5820006.0000 0.0000 391000.0000 5820006.0000 3.0000 391008.0000 5820006.0000 3.0000 391008.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod3MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="cm.b_1_house_one.b5">
<lod3MultiSurface>
<gml:MultiSurface gml:id="cm.b_1_house_one.m5">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.b_1_house_one.p5">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820006.0000 0.0000 391000.0000 5820000.0000 0.0000 391000.0000 5820000.0000 3.0000 391000.0000 5820006.0000 3.0000 391000.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod3MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:RoofSurface gml:id="_roof_1_">
<lod3MultiSurface>
<gml:MultiSurface gml:id="cm.b_1_house_one.m6">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.b_1_house_one.p6">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820000.0000 3.0000 391008.0000 5820000.0000 3.0000 391008.0000 5820006.0000 3.0000 391000.0000 5820006.0000 3.0000 391000.0000 5820000.0000 3.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod3MultiSurface>
</con:RoofSurface>
</boundary>
<lod3Solid>
<gml:Solid gml:id="cm.b_1_house_one.s0">
<gml:exterior>
<gml:Shell gml:id="cm.b_1_house_one.k0">
<gml:surfaceMember xlink:href="#cm.b_1_house_one.p0"/>
<gml:surfaceMember xlink:href="#cm.b_1_house_one.p1"/>
<gml:surfaceMember xlink:href="#cm.b_1_house_one.p2"/>
<gml:surfaceMember xlink:href="#cm.b_1_house_one.p3"/>
<gml:surfaceMember xlink:href="#cm.b_1_house_one.p4"/>
<gml:surfaceMember xlink:href="#cm.b_1_house_one.p5"/>
<gml:surfaceMember xlink:href="#cm.b_1_house_one.p6"/>
</gml:Shell>
</gml:exterior>
</gml:Solid>
</lod3Solid>
<con:dateOfConstruction>1987-05-06</con:dateOfConstruction>
<con:height>
<con:Height>
<con:highReference>highestRoofEdge</con:highReference>
<con:lowReference>lowestGroundPoint</con:lowReference>
<con:status>measured</con:status>
<con:value uom="m">3.25</con:value>
</con:Height>
</con:height>
<bldg:class>1000</bldg:class>
<bldg:function>1010</bldg:function>
<bldg:function>1020</bldg:function>
<bldg:usage>1010</bldg:usage>
<bldg:roofType>1000</bldg:roofType>
<bldg:storeysAboveGround>1</bldg:storeysAboveGround>
<bldg:buildingInstallation>
<bldg:BuildingInstallation gml:id="balcony">
<genericAttribute>
<gen:DoubleAttribute>
<gen:name>measuredHeight</gen:name>
<gen:value>1.5</gen:value>
</gen:DoubleAttribute>
</genericAttribute>
<boundary>
<con:GroundSurface gml:id="ground_3">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.balcony.m0">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.balcony.p0">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391002.0000 5819996.0000 1.0000 391004.0000 5819996.0000 1.0000 391004.0000 5819995.0000 1.0000 391002.0000 5819995.0000 1.0000 391002.0000 5819996.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:GroundSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_0_2">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.balcony.m1">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.balcony.p1">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391002.0000 5819995.0000 1.0000 391004.0000 5819995.0000 1.0000 391004.0000 5819995.0000 2.0000 391002.0000 5819995.0000 2.0000 391002.0000 5819995.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_1_2">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.balcony.m2">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.balcony.p2">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391004.0000 5819995.0000 1.0000 391004.0000 5819996.0000 1.0000 391004.0000 5819996.0000 2.0000 391004.0000 5819995.0000 2.0000 391004.0000 5819995.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_2_3">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.balcony.m3">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.balcony.p3">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391004.0000 5819996.0000 1.0000 391002.0000 5819996.0000 1.0000 391002.0000 5819996.0000 2.0000 391004.0000 5819996.0000 2.0000 391004.0000 5819996.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_3_3">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.balcony.m4">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.balcony.p4">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391002.0000 5819996.0000 1.0000 391002.0000 5819995.0000 1.0000 391002.0000 5819995.0000 2.0000 391002.0000 5819996.0000 2.0000 391002.0000 5819996.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:RoofSurface gml:id="roof_3">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.balcony.m5">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.balcony.p5">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391002.0000 5819995.0000 2.0000 391004.0000 5819995.0000 2.0000 391004.0000 5819996.0000 2.0000 391002.0000 5819996.0000 2.0000 391002.0000 5819995.0000 2.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:RoofSurface>
</boundary>
<lod2Solid>
<gml:Solid gml:id="cm.balcony.s0">
<gml:exterior>
<gml:Shell gml:id="cm.balcony.k0">
<gml:surfaceMember xlink:href="#cm.balcony.p0"/>
<gml:surfaceMember xlink:href="#cm.balcony.p1"/>
<gml:surfaceMember xlink:href="#cm.balcony.p2"/>
<gml:surfaceMember xlink:href="#cm.balcony.p3"/>
<gml:surfaceMember xlink:href="#cm.balcony.p4"/>
<gml:surfaceMember xlink:href="#cm.balcony.p5"/>
</gml:Shell>
</gml:exterior>
</gml:Solid>
</lod2Solid>
<bldg:function>1000</bldg:function>
</bldg:BuildingInstallation>
</bldg:buildingInstallation>
<bldg:address>
<Address gml:id="cm.b_1_house_one.a0">
<xalAddress>
<xAL:Address>
<xAL:Country><xAL:NameElement>Germany</xAL:NameElement></xAL:Country>
<xAL:AdministrativeArea><xAL:NameElement>BE</xAL:NameElement></xAL:AdministrativeArea>
<xAL:Locality><xAL:NameElement>Berlin</xAL:NameElement></xAL:Locality>
<xAL:Thoroughfare>
<xAL:NameElement>Main Street</xAL:NameElement>
<xAL:Number>12a</xAL:Number>
</xAL:Thoroughfare>
<xAL:PostCode><xAL:Identifier>12345</xAL:Identifier></xAL:PostCode>
<xAL:PostOffice><xAL:Identifier>PO 7</xAL:Identifier></xAL:PostOffice>
</xAL:Address>
</xalAddress>
</Address>
</bldg:address>
<bldg:address>
<Address gml:id="cm.b_1_house_one.a1">
<xalAddress>
<xAL:Address>
<xAL:Locality><xAL:NameElement>Berlin</xAL:NameElement></xAL:Locality>
<xAL:Thoroughfare>
<xAL:NameElement>Side Street</xAL:NameElement>
</xAL:Thoroughfare>
</xAL:Address>
</xalAddress>
</Address>
</bldg:address>
<bldg:buildingPart>
<bldg:BuildingPart gml:id="part">
<boundary>
<con:GroundSurface gml:id="ground">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m0">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p0">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391020.0000 5820006.0000 0.0000 391029.0000 5820006.0000 0.0000 391029.0000 5820000.0000 0.0000 391020.0000 5820000.0000 0.0000 391020.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
<gml:interior><gml:LinearRing><gml:posList srsDimension="3">391027.0000 5820002.0000 0.0000 391028.0000 5820002.0000 0.0000 391028.0000 5820004.0000 0.0000 391027.0000 5820004.0000 0.0000 391027.0000 5820002.0000 0.0000</gml:posList></gml:LinearRing></gml:interior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:GroundSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m1">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p1">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391020.0000 5820000.0000 0.0000 391029.0000 5820000.0000 0.0000 391029.0000 5820000.0000 4.0000 391020.0000 5820000.0000 4.0000 391020.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="shaft">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m2">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p2">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391028.0000 5820002.0000 0.0000 391027.0000 5820002.0000 0.0000 391027.0000 5820002.0000 4.0000 391028.0000 5820002.0000 4.0000 391028.0000 5820002.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_2">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m3">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p3">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391029.0000 5820000.0000 0.0000 391029.0000 5820006.0000 0.0000 391029.0000 5820006.0000 4.0000 391029.0000 5820000.0000 4.0000 391029.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="shaft_2">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m4">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p4">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391028.0000 5820004.0000 0.0000 391028.0000 5820002.0000 0.0000 391028.0000 5820002.0000 4.0000 391028.0000 5820004.0000 4.0000 391028.0000 5820004.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_3">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m5">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p5">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391029.0000 5820006.0000 0.0000 391020.0000 5820006.0000 0.0000 391020.0000 5820006.0000 4.0000 391029.0000 5820006.0000 4.0000 391029.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="shaft_3">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m6">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p6">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391027.0000 5820004.0000 0.0000 391028.0000 5820004.0000 0.0000 391028.0000 5820004.0000 4.0000 391027.0000 5820004.0000 4.0000 391027.0000 5820004.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_4">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m7">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p7">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391020.0000 5820006.0000 0.0000 391020.0000 5820000.0000 0.0000 391020.0000 5820000.0000 4.0000 391020.0000 5820006.0000 4.0000 391020.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="shaft_4">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m8">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p8">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391027.0000 5820002.0000 0.0000 391027.0000 5820004.0000 0.0000 391027.0000 5820004.0000 4.0000 391027.0000 5820002.0000 4.0000 391027.0000 5820002.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:RoofSurface gml:id="roof">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m9">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p9">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391020.0000 5820000.0000 4.0000 391029.0000 5820000.0000 4.0000 391029.0000 5820006.0000 4.0000 391020.0000 5820006.0000 4.0000 391020.0000 5820000.0000 4.0000</gml:posList></gml:LinearRing></gml:exterior>
<gml:interior><gml:LinearRing><gml:posList srsDimension="3">391027.0000 5820004.0000 4.0000 391028.0000 5820004.0000 4.0000 391028.0000 5820002.0000 4.0000 391027.0000 5820002.0000 4.0000 391027.0000 5820004.0000 4.0000</gml:posList></gml:LinearRing></gml:interior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:RoofSurface>
</boundary>
<boundary>
<con:InteriorWallSurface gml:id="hollow">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m10">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p10">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391021.0000 5820001.0000 1.0000 391023.0000 5820001.0000 1.0000 391023.0000 5820003.0000 1.0000 391021.0000 5820003.0000 1.0000 391021.0000 5820001.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:InteriorWallSurface>
</boundary>
<boundary>
<con:InteriorWallSurface gml:id="hollow_2">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m11">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p11">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391021.0000 5820003.0000 3.0000 391023.0000 5820003.0000 3.0000 391023.0000 5820001.0000 3.0000 391021.0000 5820001.0000 3.0000 391021.0000 5820003.0000 3.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:InteriorWallSurface>
</boundary>
<boundary>
<con:InteriorWallSurface gml:id="hollow_3">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m12">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p12">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391021.0000 5820001.0000 1.0000 391021.0000 5820001.0000 3.0000 391023.0000 5820001.0000 3.0000 391023.0000 5820001.0000 1.0000 391021.0000 5820001.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:InteriorWallSurface>
</boundary>
<boundary>
<con:InteriorWallSurface gml:id="hollow_4">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m13">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p13">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391023.0000 5820001.0000 1.0000 391023.0000 5820001.0000 3.0000 391023.0000 5820003.0000 3.0000 391023.0000 5820003.0000 1.0000 391023.0000 5820001.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:InteriorWallSurface>
</boundary>
<boundary>
<con:InteriorWallSurface gml:id="hollow_5">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m14">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p14">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391023.0000 5820003.0000 1.0000 391023.0000 5820003.0000 3.0000 391021.0000 5820003.0000 3.0000 391021.0000 5820003.0000 1.0000 391023.0000 5820003.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:InteriorWallSurface>
</boundary>
<boundary>
<con:InteriorWallSurface gml:id="hollow_6">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m15">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p15">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391021.0000 5820003.0000 1.0000 391021.0000 5820003.0000 3.0000 391021.0000 5820001.0000 3.0000 391021.0000 5820001.0000 1.0000 391021.0000 5820003.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:InteriorWallSurface>
</boundary>
<boundary>
<con:InteriorWallSurface gml:id="hollow_7">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m16">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p16">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391024.0000 5820001.0000 1.0000 391026.0000 5820001.0000 1.0000 391026.0000 5820003.0000 1.0000 391024.0000 5820003.0000 1.0000 391024.0000 5820001.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:InteriorWallSurface>
</boundary>
<boundary>
<con:InteriorWallSurface gml:id="hollow_8">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m17">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p17">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391024.0000 5820003.0000 3.0000 391026.0000 5820003.0000 3.0000 391026.0000 5820001.0000 3.0000 391024.0000 5820001.0000 3.0000 391024.0000 5820003.0000 3.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:InteriorWallSurface>
</boundary>
<boundary>
<con:InteriorWallSurface gml:id="hollow_9">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m18">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p18">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391024.0000 5820001.0000 1.0000 391024.0000 5820001.0000 3.0000 391026.0000 5820001.0000 3.0000 391026.0000 5820001.0000 1.0000 391024.0000 5820001.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:InteriorWallSurface>
</boundary>
<boundary>
<con:InteriorWallSurface gml:id="hollow_10">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m19">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p19">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391026.0000 5820001.0000 1.0000 391026.0000 5820001.0000 3.0000 391026.0000 5820003.0000 3.0000 391026.0000 5820003.0000 1.0000 391026.0000 5820001.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:InteriorWallSurface>
</boundary>
<boundary>
<con:InteriorWallSurface gml:id="hollow_11">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m20">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p20">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391026.0000 5820003.0000 1.0000 391026.0000 5820003.0000 3.0000 391024.0000 5820003.0000 3.0000 391024.0000 5820003.0000 1.0000 391026.0000 5820003.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:InteriorWallSurface>
</boundary>
<boundary>
<con:InteriorWallSurface gml:id="hollow_12">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.part.m21">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.part.p21">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391024.0000 5820003.0000 1.0000 391024.0000 5820003.0000 3.0000 391024.0000 5820001.0000 3.0000 391024.0000 5820001.0000 1.0000 391024.0000 5820003.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:InteriorWallSurface>
</boundary>
<lod2Solid>
<gml:Solid gml:id="cm.part.s0">
<gml:exterior>
<gml:Shell gml:id="cm.part.k0">
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
</gml:Shell>
</gml:exterior>
<gml:interior>
<gml:Shell gml:id="cm.part.k1">
<gml:surfaceMember xlink:href="#cm.part.p10"/>
<gml:surfaceMember xlink:href="#cm.part.p11"/>
<gml:surfaceMember xlink:href="#cm.part.p12"/>
<gml:surfaceMember xlink:href="#cm.part.p13"/>
<gml:surfaceMember xlink:href="#cm.part.p14"/>
<gml:surfaceMember xlink:href="#cm.part.p15"/>
</gml:Shell>
</gml:interior>
<gml:interior>
<gml:Shell gml:id="cm.part.k2">
<gml:surfaceMember xlink:href="#cm.part.p16"/>
<gml:surfaceMember xlink:href="#cm.part.p17"/>
<gml:surfaceMember xlink:href="#cm.part.p18"/>
<gml:surfaceMember xlink:href="#cm.part.p19"/>
<gml:surfaceMember xlink:href="#cm.part.p20"/>
<gml:surfaceMember xlink:href="#cm.part.p21"/>
</gml:Shell>
</gml:interior>
</gml:Solid>
</lod2Solid>
<bldg:roofType>flat roof</bldg:roofType>
<bldg:address>
<Address gml:id="cm.part.a0">
<xalAddress>
<xAL:Address>
<xAL:Locality><xAL:NameElement>Potsdam</xAL:NameElement></xAL:Locality>
</xAL:Address>
</xalAddress>
</Address>
</bldg:address>
</bldg:BuildingPart>
</bldg:buildingPart>
<bldg:buildingPart>
<bldg:BuildingPart gml:id="low">
<boundary>
<con:GroundSurface gml:id="ground_2">
<lod1MultiSurface>
<gml:MultiSurface gml:id="cm.low.m0">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.low.p0">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391040.0000 5820002.0000 0.0000 391042.0000 5820002.0000 0.0000 391042.0000 5820000.0000 0.0000 391040.0000 5820000.0000 0.0000 391040.0000 5820002.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod1MultiSurface>
</con:GroundSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_0">
<lod1MultiSurface>
<gml:MultiSurface gml:id="cm.low.m1">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.low.p1">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391040.0000 5820000.0000 0.0000 391042.0000 5820000.0000 0.0000 391042.0000 5820000.0000 2.0000 391040.0000 5820000.0000 2.0000 391040.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod1MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_1">
<lod1MultiSurface>
<gml:MultiSurface gml:id="cm.low.m2">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.low.p2">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391042.0000 5820000.0000 0.0000 391042.0000 5820002.0000 0.0000 391042.0000 5820002.0000 2.0000 391042.0000 5820000.0000 2.0000 391042.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod1MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_2_2">
<lod1MultiSurface>
<gml:MultiSurface gml:id="cm.low.m3">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.low.p3">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391042.0000 5820002.0000 0.0000 391040.0000 5820002.0000 0.0000 391040.0000 5820002.0000 2.0000 391042.0000 5820002.0000 2.0000 391042.0000 5820002.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod1MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_3_2">
<lod1MultiSurface>
<gml:MultiSurface gml:id="cm.low.m4">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.low.p4">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391040.0000 5820002.0000 0.0000 391040.0000 5820000.0000 0.0000 391040.0000 5820000.0000 2.0000 391040.0000 5820002.0000 2.0000 391040.0000 5820002.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod1MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:RoofSurface gml:id="roof_2">
<lod1MultiSurface>
<gml:MultiSurface gml:id="cm.low.m5">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.low.p5">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391040.0000 5820000.0000 2.0000 391042.0000 5820000.0000 2.0000 391042.0000 5820002.0000 2.0000 391040.0000 5820002.0000 2.0000 391040.0000 5820000.0000 2.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod1MultiSurface>
</con:RoofSurface>
</boundary>
<lod1Solid>
<gml:Solid gml:id="cm.low.s0">
<gml:exterior>
<gml:Shell gml:id="cm.low.k0">
<gml:surfaceMember xlink:href="#cm.low.p0"/>
<gml:surfaceMember xlink:href="#cm.low.p1"/>
<gml:surfaceMember xlink:href="#cm.low.p2"/>
<gml:surfaceMember xlink:href="#cm.low.p3"/>
<gml:surfaceMember xlink:href="#cm.low.p4"/>
<gml:surfaceMember xlink:href="#cm.low.p5"/>
</gml:Shell>
</gml:exterior>
</gml:Solid>
</lod1Solid>
</bldg:BuildingPart>
</bldg:buildingPart>
</bldg:Building>
</cityObjectMember>
<cityObjectMember>
<bldg:Building gml:id="cube">
<gml:metaDataProperty><gml:GenericMetaData>citymesh rung as_is</gml:GenericMetaData></gml:metaDataProperty>
<boundary>
<con:GroundSurface gml:id="ground_4">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m0">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p0">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820001.0000 0.0000 391001.0000 5820001.0000 0.0000 391001.0000 5820000.0000 0.0000 391000.0000 5820000.0000 0.0000 391000.0000 5820001.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:GroundSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_0_3">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m1">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p1">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820000.0000 0.0000 391001.0000 5820000.0000 0.0000 391001.0000 5820000.0000 1.0000 391000.0000 5820000.0000 1.0000 391000.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_1_3">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m2">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p2">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391001.0000 5820000.0000 0.0000 391001.0000 5820001.0000 0.0000 391001.0000 5820001.0000 1.0000 391001.0000 5820000.0000 1.0000 391001.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_2_4">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m3">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p3">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391001.0000 5820001.0000 0.0000 391000.0000 5820001.0000 0.0000 391000.0000 5820001.0000 1.0000 391001.0000 5820001.0000 1.0000 391001.0000 5820001.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_3_4">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m4">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p4">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820001.0000 0.0000 391000.0000 5820000.0000 0.0000 391000.0000 5820000.0000 1.0000 391000.0000 5820001.0000 1.0000 391000.0000 5820001.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:RoofSurface gml:id="roof_4">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m5">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p5">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820000.0000 1.0000 391001.0000 5820000.0000 1.0000 391001.0000 5820001.0000 1.0000 391000.0000 5820001.0000 1.0000 391000.0000 5820000.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:RoofSurface>
</boundary>
<lod2Solid>
<gml:Solid gml:id="cm.cube.s0">
<gml:exterior>
<gml:Shell gml:id="cm.cube.k0">
<gml:surfaceMember xlink:href="#cm.cube.p0"/>
<gml:surfaceMember xlink:href="#cm.cube.p1"/>
<gml:surfaceMember xlink:href="#cm.cube.p2"/>
<gml:surfaceMember xlink:href="#cm.cube.p3"/>
<gml:surfaceMember xlink:href="#cm.cube.p4"/>
<gml:surfaceMember xlink:href="#cm.cube.p5"/>
</gml:Shell>
</gml:exterior>
</gml:Solid>
</lod2Solid>
<con:height>
<con:Height>
<con:highReference>highestRoofEdge</con:highReference>
<con:lowReference>lowestGroundPoint</con:lowReference>
<con:status>measured</con:status>
<con:value uom="m">1</con:value>
</con:Height>
</con:height>
<bldg:function>31001_1000</bldg:function>
</bldg:Building>
</cityObjectMember>
</CityModel>
